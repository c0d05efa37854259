// SPDX-License-Identifier: MIT
// Pinhole camera with one radial term, and the pose of a camera.
#pragma once

#include <Eigen/Core>

namespace unisim::geometric {

/// Pose of a camera: a world point X has camera coordinates R * X + t. Axes: x right, y down, z
/// ahead.
struct CameraPose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  Eigen::Vector3d apply(const Eigen::Vector3d& point_world) const { return R * point_world + t; }
  Eigen::Vector3d center() const { return -(R.transpose() * t); }  ///< in the world
};

/// Rotation matrix of a rotation vector (radians).
Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& rotation_rad);

/// Moves `pose` by a camera-frame twist (translation 3, rotation 3): T <- exp-like(step) * T with
/// R <- Exp(rotation) R, t <- Exp(rotation) t + translation, and makes R orthonormal again.
CameraPose retract(const CameraPose& pose, const Eigen::Matrix<double, 6, 1>& step);

/// Pinhole with undistorted = distorted (1 + k1 r^2), both measured from (cx, cy), r = |distorted|
/// in focal lengths. All pixels are full-resolution pixels, centre of the first pixel at (0, 0).
struct CameraModel {
  double focal_px = 1.0;
  double k1 = 0.0;
  double cx = 0.0;
  double cy = 0.0;

  /// Pixel of the ideal pinhole seen at distorted `pixel`. Closed form, always finite.
  Eigen::Vector2d undistort(const Eigen::Vector2d& pixel) const;
  /// Ray through distorted `pixel` as (x / z, y / z).
  Eigen::Vector2d normalize(const Eigen::Vector2d& pixel) const;
  /// Inverse of undistort(). False, `pixel` untouched, where the model folds over (only k1 < 0, far
  /// outside any sensible image).
  bool distort(const Eigen::Vector2d& undistorted, Eigen::Vector2d* pixel) const;
  /// Undistorted pixel of a camera-frame point. False, `pixel` untouched, at or behind the camera.
  bool project_undistorted(const Eigen::Vector3d& point_camera, Eigen::Vector2d* pixel) const;
  /// Distorted pixel (as in the image) of a camera-frame point; false as above and as distort().
  bool project(const Eigen::Vector3d& point_camera, Eigen::Vector2d* pixel) const;
};

/// Smallest depth that counts as in front of a camera, in scene units.
inline constexpr double kMinDepth = 1e-6;

}  // namespace unisim::geometric
