// SPDX-License-Identifier: MIT
// Ratio of two depth maps of the same keyframe, with its scatter.
#include "core/depth/log_median_ratio.hpp"

#include <cmath>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"

namespace unisim {
namespace {

bool has_depth(float depth) { return std::isfinite(depth) && depth > 0.0f; }

}  // namespace

Status log_median_ratio(Span<const float> a, Span<const float> b, Span<float> scratch,
                        LogMedianRatio* out) {
  if (a.size() != b.size() || scratch.size() < log_median_ratio_scratch(a.size())) {
    return Status::kInvalidArgument;
  }
  int32_t count = 0;
  for (int32_t i = 0; i < a.size(); ++i) {
    if (!has_depth(a[i]) || !has_depth(b[i])) continue;
    const float log_ratio = math::log(a[i] / b[i]);
    if (std::isfinite(log_ratio)) scratch[count++] = log_ratio;
  }
  if (count == 0) return Status::kNotReady;
  const Span<float> ratios = scratch.subspan(0, count);
  const double log_ratio = median(ratios);
  for (float& r : ratios) r = static_cast<float>(std::abs(static_cast<double>(r) - log_ratio));
  *out = {log_ratio, median(ratios), count};
  return Status::kOk;
}

}  // namespace unisim
