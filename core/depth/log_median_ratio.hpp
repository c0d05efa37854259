// SPDX-License-Identifier: MIT
// Ratio of two depth maps of the same keyframe, with its scatter.
#pragma once

#include <cstdint>

#include "core/base/span.hpp"
#include "core/base/status.hpp"

namespace unisim {

/// Depth map sampled on a grid; both maps of a ratio have the same grid.
struct DepthGrid {
  Span<const float> depth;       ///< z-depths; not finite or <= 0: no depth there
  Span<const float> confidence;  ///< same length, only the order counts; empty: all equal
};

/// How depth a compares with depth b.
struct LogMedianRatio {
  double log_ratio;  ///< median of log(a / b): the log of the median ratio
  double scatter;    ///< median absolute deviation of the pixels' log ratios from log_ratio
  int32_t count;     ///< pixels used
};

/// Floats of scratch that log_median_ratio() needs for grids of `pixels`.
constexpr int32_t log_median_ratio_scratch(int32_t pixels) { return pixels; }

/// log median of a/b over the pixels valid and confident in both.
///
/// @param a, b            grids of equal length
/// @param confidence_drop share 0..0.9 of each map's valid pixels, least confident first, left out;
///                        pixels that tie with the limit stay
/// @param scratch         at least log_median_ratio_scratch(pixels) floats
/// @param[out] out        written on success
/// @return kOk; kInvalidArgument when lengths differ, scratch is short or confidence_drop is out of
///         range; kNotReady when no pixel is left
Status log_median_ratio(const DepthGrid& a, const DepthGrid& b, double confidence_drop,
                        Span<float> scratch, LogMedianRatio* out);

}  // namespace unisim
