// SPDX-License-Identifier: MIT
// Which poses of two trajectories belong together.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

struct IndexPair {
  size_t ground_truth;
  size_t estimate;
};

/// Gives each pose of the shorter trajectory the pose of the other that is nearest in time, if it
/// is within max_dt_s: the rule of evo. A pose of the longer one may serve twice. O(n log m) for
/// sorted times.
/// @throws InputError when no pose has a partner, or one has frame numbers and the other times; it
/// names both ranges
std::vector<IndexPair> associate(const Trajectory& ground_truth, const Trajectory& estimate,
                                 double max_dt_s);

}  // namespace unisim::eval
