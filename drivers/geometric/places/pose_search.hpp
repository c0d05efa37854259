// SPDX-License-Identifier: MIT
// Pose of a camera from points of which most are wrong: P3P on three at a time (RANSAC), the likely
// ones first.
#pragma once

#include <vector>

#include "drivers/geometric/bundle/pose_solver.hpp"

namespace unisim::geometric {

/// @param observations the most trusted first
/// @param gate pixels within which an observation agrees
/// @return how many agree with the best pose found; 0: no pose. The same observations give the same
///         pose
int search_pose(const CameraModel& camera, const std::vector<PoseObservation>& observations,
                double gate, CameraPose* pose);

}  // namespace unisim::geometric
