// SPDX-License-Identifier: MIT
// Of binary descriptors in groups: the nearest one and the nearest of another group, and the
// features of an image that look like one of them.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/places/orb.hpp"

namespace unisim::geometric {

inline constexpr int32_t kFarther = 8 * kOrbBytes + 1;  ///< than any descriptor

struct NearestDescriptors {
  int32_t group = -1;            ///< of the nearest; of equals the first
  int32_t distance = kFarther;   ///< Hamming
  int32_t runner_up = kFarther;  ///< distance to the nearest of all other groups
};

/// @param descriptors those of a group follow one another  @param groups of each of them
/// @param query kOrbBytes
NearestDescriptors nearest_descriptors(const std::vector<OrbDescriptor>& descriptors,
                                       const std::vector<int32_t>& groups, const uint8_t* query);

/// A feature and the group that it looks like.
struct FeaturePair {
  int32_t feature;
  int32_t group;
  int32_t distance;
};

/// Pairs features with groups: the least Hamming distance, clearly less than to any other group,
/// one to one, in the order of the groups.
/// @param descriptors, groups as above  @param count of groups
/// @param most of the features, the strongest
void match_features(const OrbFeatureSet& features, const std::vector<OrbDescriptor>& descriptors,
                    const std::vector<int32_t>& groups, size_t count, int32_t most,
                    std::vector<FeaturePair>* out);

}  // namespace unisim::geometric
