// SPDX-License-Identifier: MIT
// Depth maps of any size brought onto one grid.
#include "core/map/depth_sampler.hpp"

#include <cmath>

#include "core/depth/nth_element.hpp"

namespace unisim {
namespace {

/// Pixel of `pixels` that holds the centre of `cell` of `cells`.
int32_t pixel_of_cell(int32_t cell, int32_t cells, int32_t pixels) {
  return static_cast<int32_t>((2 * static_cast<int64_t>(cell) + 1) * pixels /
                              (2 * static_cast<int64_t>(cells)));
}

int64_t pixel_index(const DepthMap& map, GridSize grid, int32_t cell) {
  const int32_t x = pixel_of_cell(cell % grid.width, grid.width, map.width);
  const int32_t y = pixel_of_cell(cell / grid.width, grid.height, map.height);
  return static_cast<int64_t>(y) * map.width + x;
}

bool has_depth(const DepthMap& map, int64_t pixel) {
  const float depth = map.depth[pixel];
  if (!std::isfinite(depth) || depth <= 0.0F) return false;
  return map.confidence == nullptr || std::isfinite(map.confidence[pixel]);
}

}  // namespace

int32_t sample_depth(const DepthMap& map, GridSize grid, double confidence_drop,
                     Span<float> samples, Span<float> scratch) {
  UNISIM_CHECK(samples.size() == grid.cells() && scratch.size() >= grid.cells());
  int32_t count = 0;
  for (int32_t cell = 0; cell < grid.cells(); ++cell) {
    const int64_t pixel = pixel_index(map, grid, cell);
    const bool valid = has_depth(map, pixel);
    samples[cell] = valid ? map.depth[pixel] : 0.0F;
    if (valid && map.confidence != nullptr) scratch[count] = map.confidence[pixel];
    count += valid ? 1 : 0;
  }
  const auto dropped = static_cast<int32_t>(confidence_drop * count);
  if (map.confidence == nullptr || dropped == 0) return count;
  const float limit = nth_element(scratch.subspan(0, count), dropped);
  for (int32_t cell = 0; cell < grid.cells(); ++cell) {
    if (samples[cell] > 0.0F && map.confidence[pixel_index(map, grid, cell)] < limit) {
      samples[cell] = 0.0F;
      --count;
    }
  }
  return count;
}

}  // namespace unisim
