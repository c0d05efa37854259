// SPDX-License-Identifier: MIT
// Ratio of two depth maps of the same keyframe, with its scatter.
#include "core/depth/log_median_ratio.hpp"

#include <cmath>
#include <limits>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"

namespace unisim {
namespace {

bool has_depth(float depth) { return std::isfinite(depth) && depth > 0.0f; }

bool has_confidence(float confidence) { return std::isfinite(confidence); }

// Confidence below which a pixel is among the `drop` least confident ones that have depth.
float confidence_limit(const DepthGrid& grid, double drop, Span<float> scratch) {
  constexpr float kNoLimit = -std::numeric_limits<float>::infinity();
  if (grid.confidence.empty()) return kNoLimit;
  int32_t count = 0;
  for (int32_t i = 0; i < grid.depth.size(); ++i) {
    if (has_depth(grid.depth[i]) && has_confidence(grid.confidence[i])) {
      scratch[count++] = grid.confidence[i];
    }
  }
  const int32_t dropped = static_cast<int32_t>(drop * count);
  if (dropped == 0) return kNoLimit;
  return nth_element(scratch.subspan(0, count), dropped);
}

bool usable(const DepthGrid& grid, float limit, int32_t i) {
  if (!has_depth(grid.depth[i])) return false;
  if (grid.confidence.empty()) return true;
  return has_confidence(grid.confidence[i]) && grid.confidence[i] >= limit;
}

bool consistent(const DepthGrid& a, const DepthGrid& b, double drop, Span<float> scratch) {
  const int32_t pixels = a.depth.size();
  return b.depth.size() == pixels && (a.confidence.empty() || a.confidence.size() == pixels) &&
         (b.confidence.empty() || b.confidence.size() == pixels) && drop >= 0.0 && drop <= 0.9 &&
         scratch.size() >= log_median_ratio_scratch(pixels);
}

}  // namespace

Status log_median_ratio(const DepthGrid& a, const DepthGrid& b, double confidence_drop,
                        Span<float> scratch, LogMedianRatio* out) {
  if (!consistent(a, b, confidence_drop, scratch)) return Status::kInvalidArgument;
  const float limit_a = confidence_limit(a, confidence_drop, scratch);
  const float limit_b = confidence_limit(b, confidence_drop, scratch);
  int32_t count = 0;
  for (int32_t i = 0; i < a.depth.size(); ++i) {
    if (!usable(a, limit_a, i) || !usable(b, limit_b, i)) continue;
    const float log_ratio = math::log(a.depth[i] / b.depth[i]);
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
