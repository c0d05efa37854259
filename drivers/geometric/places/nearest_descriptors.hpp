// SPDX-License-Identifier: MIT
// Of binary descriptors in groups: the nearest one and the nearest of another group.
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

}  // namespace unisim::geometric
