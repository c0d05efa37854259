// SPDX-License-Identifier: MIT
// A similarity between two worlds, and what it does to poses.
#pragma once

#include <Eigen/Geometry>

#include "drivers/geometric/bundle/camera_model.hpp"

namespace unisim::geometric {

/// p' = scale R p + t.
struct WorldMove {
  double scale = 1;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  /// Takes a camera from one pose to another.
  static WorldMove between(const CameraPose& from, const CameraPose& to, double scale) {
    WorldMove out;
    out.scale = scale;
    out.R = to.R.transpose() * from.R;
    out.t = to.center() - scale * (out.R * from.center());
    return out;
  }

  Eigen::Vector3d apply(const Eigen::Vector3d& point) const { return scale * (R * point) + t; }

  /// The pose in the new world of a camera with `pose` in the old one.
  CameraPose apply(const CameraPose& pose) const {
    CameraPose out;
    out.R = pose.R * R.transpose();
    out.t = -(out.R * apply(pose.center()));
    return out;
  }

  WorldMove inverse() const {
    WorldMove out;
    out.scale = 1 / scale;
    out.R = R.transpose();
    out.t = -out.scale * (out.R * t);
    return out;
  }
};

/// Angle between two rotations.
inline double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a.transpose() * b)).angle();
}

}  // namespace unisim::geometric
