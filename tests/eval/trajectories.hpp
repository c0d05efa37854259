// SPDX-License-Identifier: MIT
// Small trajectories made by formula.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "tools/eval/trajectory.hpp"

/// Poses one second apart at the given positions, not turned.
inline unisim::eval::Trajectory at_positions(const std::vector<Eigen::Vector3d>& positions,
                                             double first_time_s = 0.0) {
  unisim::eval::Trajectory trajectory{"made", "tum", {}, 0};
  for (size_t k = 0; k < positions.size(); ++k) {
    trajectory.poses.push_back(
        {first_time_s + static_cast<double>(k), Eigen::Matrix3d::Identity(), positions[k]});
  }
  return trajectory;
}

/// A turning helix of `count` poses, 0.1 s apart.
inline unisim::eval::Trajectory helix(size_t count) {
  unisim::eval::Trajectory trajectory{"helix", "tum", {}, 0};
  for (size_t k = 0; k < count; ++k) {
    const double a = 0.1 * static_cast<double>(k);
    const Eigen::AngleAxisd turn(a, Eigen::Vector3d(0.1, 1.0, 0.2).normalized());
    trajectory.poses.push_back(
        {a, turn.toRotationMatrix(), Eigen::Vector3d(std::cos(a), 0.05 * a, std::sin(a))});
  }
  return trajectory;
}
