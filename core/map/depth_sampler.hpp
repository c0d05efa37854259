// SPDX-License-Identifier: MIT
// Depth maps of any size brought onto one grid.
#pragma once

#include <cstdint>

#include "core/base/span.hpp"

namespace unisim {

/// Depth map of one keyframe in one prediction, as the host hands it in.
/// A pixel whose depth or confidence is not finite, or whose depth is <= 0, has no depth.
struct DepthMap {
  const float* depth = nullptr;       ///< height*width z-depths, row-major
  const float* confidence = nullptr;  ///< same shape, only its order counts; null: all equal
  int32_t width = 0;
  int32_t height = 0;
};

/// Cells of a sampling grid, spread evenly over the image whatever its size in pixels.
struct GridSize {
  int32_t width = 0;
  int32_t height = 0;
  constexpr int32_t cells() const { return width * height; }
};

/// Depth at the pixel nearest to each cell's centre; 0 where there is none.
///
/// @param confidence_drop share of the sampled pixels with depth, least confident first, that is
/// left
///                        out; pixels that tie with the limit stay
/// @param[out] samples    grid.cells() depths, row-major
/// @param scratch         grid.cells() floats
/// @return number of cells with a depth
int32_t sample_depth(const DepthMap& map, GridSize grid, double confidence_drop,
                     Span<float> samples, Span<float> scratch);

}  // namespace unisim
