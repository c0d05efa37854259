// SPDX-License-Identifier: MIT
// How the scale of a trajectory varies along it.
#include "tools/replay/report/local_scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace unisim::report {
namespace {

/// Root mean square distance of points [first, last) from their mean.
double spread(const std::vector<Point>& points, std::size_t first, std::size_t last) {
  const auto count = static_cast<double>(last - first);
  double mean[3] = {0.0, 0.0, 0.0};
  for (std::size_t k = first; k < last; ++k) {
    mean[0] += points[k].x / count;
    mean[1] += points[k].y / count;
    mean[2] += points[k].z / count;
  }
  double sum = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    const double dx = points[k].x - mean[0];
    const double dy = points[k].y - mean[1];
    const double dz = points[k].z - mean[2];
    sum += dx * dx + dy * dy + dz * dz;
  }
  return std::sqrt(sum / count);
}

}  // namespace

std::vector<Sample> local_scale(const std::vector<Point>& estimate, const std::vector<Point>& truth,
                                int half) {
  std::vector<Sample> samples;
  const std::size_t count = std::min(estimate.size(), truth.size());
  const auto reach = static_cast<std::size_t>(std::max(half, 1));
  if (count < 2 * reach + 1) return samples;
  const double least = 1e-3 * spread(truth, 0, count);
  for (std::size_t k = reach; k + reach < count; ++k) {
    if (estimate[k - reach].segment != estimate[k + reach].segment) continue;
    const double truth_spread = spread(truth, k - reach, k + reach + 1);
    if (!(truth_spread > least)) continue;
    const double scale = spread(estimate, k - reach, k + reach + 1) / truth_spread;
    samples.push_back({estimate[k].time_s, scale, estimate[k].segment});
  }
  return samples;
}

}  // namespace unisim::report
