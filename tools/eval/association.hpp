// SPDX-License-Identifier: MIT
// Which poses of two trajectories belong together.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/eval/score_error.hpp"
#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

struct IndexPair {
  size_t ground_truth;
  size_t estimate;
};

/// Gives each pose of the shorter trajectory the pose of the other that is nearest in time, if it
/// is within max_dt_s: the rule of evo. A pose of the longer one may serve twice. O(n log m).
///
/// KITTI poses without frame numbers have none but their line: two such files must have as many
/// lines, as for evo, and beside one with frame numbers every frame of it must have its line.
/// @throws ScoreError when no pose has a partner, InputError when nothing tells which pose is
/// which; it names both ranges
std::vector<IndexPair> associate(const Trajectory& ground_truth, const Trajectory& estimate,
                                 double max_dt_s);

/// What told which poses belong together: "time", "frame number" or "line".
const char* association_name(const Trajectory& ground_truth, const Trajectory& estimate);

}  // namespace unisim::eval
