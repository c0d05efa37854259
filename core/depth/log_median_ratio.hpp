// SPDX-License-Identifier: MIT
// Ratio of two depth maps of the same keyframe, with its scatter.
#pragma once

#include <cstdint>

#include "core/base/span.hpp"
#include "core/base/status.hpp"

namespace unisim {

/// How depth a compares with depth b.
struct LogMedianRatio {
  double log_ratio;  ///< median of log(a / b): the log of the median ratio
  double scatter;    ///< median absolute deviation of the pixels' log ratios from log_ratio
  int32_t count;     ///< pixels used
};

/// Floats of scratch that log_median_ratio() needs for grids of `pixels`.
constexpr int32_t log_median_ratio_scratch(int32_t pixels) { return pixels; }

/// log median of a/b over the pixels that have depth in both.
///
/// @param a, b      z-depths on the same grid; not finite or <= 0: no depth there
/// @param scratch   at least log_median_ratio_scratch(pixels) floats
/// @param[out] out  written on success
/// @return kOk; kInvalidArgument when lengths differ or scratch is short; kNotReady when no pixel
///         has depth in both
Status log_median_ratio(Span<const float> a, Span<const float> b, Span<float> scratch,
                        LogMedianRatio* out);

}  // namespace unisim
