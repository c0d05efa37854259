// SPDX-License-Identifier: MIT
// Of binary descriptors in groups: the nearest one, and the features that look like one of them.
#include "drivers/geometric/places/nearest_descriptors.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace unisim::geometric {

namespace {

// Redkitchen, pairs of keyframes by overlap: with 72 and 0.9 too many wrong pairs come through for
// the rounds of the pose search.
constexpr int32_t kMaxDistance = 64;
constexpr double kMaxRatio = 0.8;

constexpr size_t kWords = kOrbBytes / sizeof(uint64_t);

// One image against one place is a million distances and more; cv::BFMatcher takes a call for each,
// and six times as long. Counting bits is one instruction since 2008, which a build for all
// processors may not take for granted: one copy with it, one without.
[[gnu::always_inline]] inline NearestDescriptors scan(const OrbDescriptor* descriptors,
                                                      const int32_t* groups, size_t count,
                                                      const uint8_t* query) {
  uint64_t wanted[kWords];
  std::memcpy(wanted, query, sizeof wanted);
  NearestDescriptors out;
  for (size_t i = 0; i < count; ++i) {
    uint64_t bits[kWords];
    std::memcpy(bits, descriptors + i, sizeof bits);
    int32_t distance = 0;
    for (size_t w = 0; w < kWords; ++w) distance += __builtin_popcountll(bits[w] ^ wanted[w]);
    if (distance >= out.runner_up) continue;
    if (groups[i] == out.group) {
      if (distance < out.distance) out.distance = distance;
    } else if (distance < out.distance) {
      out.runner_up = out.distance;
      out.distance = distance;
      out.group = groups[i];
    } else {
      out.runner_up = distance;
    }
  }
  return out;
}

#if defined(__x86_64__) || defined(__i386__)
[[gnu::target("popcnt")]] NearestDescriptors scan_counting_bits(const OrbDescriptor* descriptors,
                                                                const int32_t* groups, size_t count,
                                                                const uint8_t* query) {
  return scan(descriptors, groups, count, query);
}
#endif

}  // namespace

NearestDescriptors nearest_descriptors(const std::vector<OrbDescriptor>& descriptors,
                                       const std::vector<int32_t>& groups, const uint8_t* query) {
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("popcnt")) {
    return scan_counting_bits(descriptors.data(), groups.data(), descriptors.size(), query);
  }
#endif
  return scan(descriptors.data(), groups.data(), descriptors.size(), query);
}

void match_features(const OrbFeatureSet& features, const std::vector<OrbDescriptor>& descriptors,
                    const std::vector<int32_t>& groups, size_t count, int32_t most,
                    std::vector<FeaturePair>* out) {
  out->clear();
  std::vector<FeaturePair> best(count, {-1, -1, 0});
  for (int f = 0; f < std::min(features.descriptor.rows, most); ++f) {
    const NearestDescriptors nearest =
        nearest_descriptors(descriptors, groups, features.descriptor.ptr<uint8_t>(f));
    if (nearest.distance > kMaxDistance || nearest.distance > kMaxRatio * nearest.runner_up) {
      continue;
    }
    FeaturePair& kept = best[static_cast<size_t>(nearest.group)];
    if (kept.feature >= 0 && kept.distance <= nearest.distance) continue;
    kept = {f, nearest.group, nearest.distance};
  }
  std::copy_if(best.begin(), best.end(), std::back_inserter(*out),
               [](const FeaturePair& pair) { return pair.feature >= 0; });
}

}  // namespace unisim::geometric
