// SPDX-License-Identifier: MIT
// Which poses of a run are compared with which of the ground truth.
#pragma once

#include <string>

#include "tools/eval/trajectory.hpp"

namespace unisim::replay {

/// Largest time difference of two poses that are compared as they are.
inline constexpr double kMaxTimeDifferenceSeconds = 0.02;

/// What is compared.
struct ScorePoses {
  eval::Trajectory truth;
  eval::Trajectory estimate;
  std::string what;  ///< for the protocol
};

/// The keyframes as they are, where at least half of what could meet the ground truth does; else
/// all frames on the same terms; else the denser of the two sides is interpolated at the times of
/// the other.
/// @param name      of the keyframes, for the protocol
/// @param frames    poses of all frames, empty if there are none
ScorePoses choose_poses(const eval::Trajectory& truth, const eval::Trajectory& keyframes,
                        const std::string& name, const eval::Trajectory& frames);

}  // namespace unisim::replay
