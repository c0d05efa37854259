// SPDX-License-Identifier: MIT
// Camera pose of the simulated world: rotation and position, metres.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace unisim::simulator {

/// p' = R p + t.
struct RigidPose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  RigidPose inverse() const { return {R.transpose(), -(R.transpose() * t)}; }
};

inline RigidPose operator*(const RigidPose& a, const RigidPose& b) {
  return {a.R * b.R, a.R * b.t + a.t};
}

/// Rotation by a vector whose length is the angle [rad].
inline Eigen::Matrix3d rotation(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle < 1e-15) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

}  // namespace unisim::simulator
