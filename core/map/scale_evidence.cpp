// SPDX-License-Identifier: MIT
// What is known of the length of a unit in metres: mean of the logarithm with its information.
#include "core/map/scale_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "core/depth/nth_element.hpp"

namespace unisim {

ScaleEvidence fuse(const ScaleEvidence& one, const ScaleEvidence& other) {
  const double sum = one.information + other.information;
  if (!(sum > 0.0)) return {};
  const double share = other.information / sum;
  return {one.log_metres + share * (other.log_metres - one.log_metres), sum};
}

ScaleEvidence fuse(Span<const ScaleEvidence> all) {
  ScaleEvidence mean;
  for (const ScaleEvidence& one : all) mean = fuse(mean, one);
  double chi2 = 0.0;
  for (const ScaleEvidence& one : all) {
    const double apart = one.log_metres - mean.log_metres;
    chi2 += one.information * apart * apart;
  }
  const double excess = all.size() > 1 ? chi2 / (all.size() - 1) : 0.0;
  mean.information /= std::max(1.0, excess);
  return mean;
}

bool Consensus::accepts(double value, double information) const {
  constexpr int32_t kFewest = 5;
  constexpr double kWidths = 4.0;
  if (count < kFewest) return true;
  const double apart = value - median;
  return apart * apart <= kWidths * kWidths * (1.0 / information + spread * spread);
}

Consensus consensus_of(Span<double> values) {
  constexpr double kNormal = 1.4826;  // standard deviations per median absolute deviation
  Consensus all;
  all.count = values.size();
  all.median = median(values);
  for (double& value : values) value = std::abs(value - all.median);
  all.spread = kNormal * median(values);
  return all;
}

}  // namespace unisim
