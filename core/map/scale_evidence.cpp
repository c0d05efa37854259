// SPDX-License-Identifier: MIT
// What is known of the length of a unit in metres: mean of the logarithm with its information.
#include "core/map/scale_evidence.hpp"

#include <algorithm>
#include <cmath>

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

double Consensus::weight(const ScaleEvidence& one) const {
  constexpr int32_t kFewest = 5;
  constexpr double kWidths = 3.0;
  if (count < kFewest) return 1.0;
  const double variance = std::max(1.0 / one.information, spread * spread);
  const double apart = one.log_metres - center;
  const double share = apart * apart / (kWidths * kWidths * variance);
  return share < 1.0 ? (1.0 - share) * (1.0 - share) : 0.0;
}

namespace {

/// By insertion: they are few, and std::sort would be 2 kB of code.
void sort_by_metres(Span<ScaleEvidence> all) {
  for (int32_t k = 1; k < all.size(); ++k) {
    const ScaleEvidence one = all[k];
    int32_t to = k;
    for (; to > 0 && one.log_metres < all[to - 1].log_metres; --to) all[to] = all[to - 1];
    all[to] = one;
  }
}

}  // namespace

Consensus consensus_of(Span<ScaleEvidence> all) {
  constexpr int32_t kRounds = 3;
  // Standard deviations of a normal distribution in half the length of its middle half.
  constexpr double kHalf = 0.6745;
  sort_by_metres(all);
  Consensus most;
  most.count = all.size();
  const int32_t half = all.size() / 2;
  double shortest = all[half].log_metres - all[0].log_metres;
  int32_t first = 0;
  for (int32_t k = 1; k + half < all.size(); ++k) {
    const double length = all[k + half].log_metres - all[k].log_metres;
    if (length >= shortest) continue;
    shortest = length;
    first = k;
  }
  most.center = all[first].log_metres + 0.5 * shortest;
  most.spread = 0.5 * shortest / kHalf;
  for (int32_t round = 0; round < kRounds; ++round) {
    ScaleEvidence mean;
    for (const ScaleEvidence& one : all) {
      mean = fuse(mean, {one.log_metres, one.information * most.weight(one)});
    }
    if (mean.known()) most.center = mean.log_metres;
  }
  return most;
}

}  // namespace unisim
