// SPDX-License-Identifier: MIT
// How differently two cameras see a point.
#pragma once

#include "drivers/geometric/bundle/camera_model.hpp"

namespace unisim::geometric {

/// view_difference() of views that no patch can bridge.
inline constexpr double kNoView = 1e9;

/// Difference of two views of a point in the world: change of depth, of direction and of roll, each
/// in units of what a patch bears; 0: the same, kNoView: too different in one of them.
double view_difference(const CameraPose& a, const CameraPose& b, const Eigen::Vector3d& point);

/// Rotation of the image from a's to b's about the optical axis, radians.
double roll_between(const CameraPose& a, const CameraPose& b);

}  // namespace unisim::geometric
