// SPDX-License-Identifier: MIT
// Pinhole camera with one radial term, and the pose of a camera.
#include "drivers/geometric/bundle/camera_model.hpp"

#include <cmath>

namespace unisim::geometric {

Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& rotation_rad) {
  const double x = rotation_rad.x();
  const double y = rotation_rad.y();
  const double z = rotation_rad.z();
  const double theta2 = rotation_rad.squaredNorm();
  double a = 1.0 - theta2 / 6.0;   // sin(theta) / theta
  double b = 0.5 - theta2 / 24.0;  // (1 - cos(theta)) / theta^2
  if (theta2 > 1e-8) {
    const double theta = std::sqrt(theta2);
    a = std::sin(theta) / theta;
    b = (1.0 - std::cos(theta)) / theta2;
  }
  Eigen::Matrix3d K;
  K << 0.0, -z, y, z, 0.0, -x, -y, x, 0.0;
  return Eigen::Matrix3d::Identity() + a * K + b * (K * K);
}

CameraPose retract(const CameraPose& pose, const Eigen::Matrix<double, 6, 1>& step) {
  const Eigen::Matrix3d E = rotation_exp(step.tail<3>());
  CameraPose moved;
  const Eigen::Matrix3d R = E * pose.R;
  // One Newton step towards the nearest rotation keeps rounding from adding up over many updates.
  moved.R = 1.5 * R - 0.5 * R * (R.transpose() * R);
  moved.t = E * pose.t + step.head<3>();
  return moved;
}

Eigen::Vector2d CameraModel::undistort(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d d(pixel.x() - cx, pixel.y() - cy);
  const double stretch = 1.0 + k1 * d.squaredNorm() / (focal_px * focal_px);
  return Eigen::Vector2d(cx + d.x() * stretch, cy + d.y() * stretch);
}

Eigen::Vector2d CameraModel::normalize(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d u = undistort(pixel);
  return Eigen::Vector2d((u.x() - cx) / focal_px, (u.y() - cy) / focal_px);
}

bool CameraModel::distort(const Eigen::Vector2d& undistorted, Eigen::Vector2d* pixel) const {
  const Eigen::Vector2d u(undistorted.x() - cx, undistorted.y() - cy);
  const double target = u.norm() / focal_px;
  double r = target;
  bool solved = false;
  for (int i = 0; i < 20 && !solved; ++i) {
    const double slope = 1.0 + 3.0 * k1 * r * r;
    if (!(slope > 1e-3)) return false;
    const double step = (r * (1.0 + k1 * r * r) - target) / slope;
    r -= step;
    solved = std::abs(step) <= 1e-14 * (1.0 + r);
  }
  if (!solved || !(1.0 + 3.0 * k1 * r * r > 0.0)) return false;
  const double shrink = 1.0 / (1.0 + k1 * r * r);
  *pixel = Eigen::Vector2d(cx + u.x() * shrink, cy + u.y() * shrink);
  return true;
}

bool CameraModel::project_undistorted(const Eigen::Vector3d& point_camera,
                                      Eigen::Vector2d* pixel) const {
  if (!(point_camera.z() > kMinDepth)) return false;
  const double scale = focal_px / point_camera.z();
  *pixel = Eigen::Vector2d(cx + scale * point_camera.x(), cy + scale * point_camera.y());
  return true;
}

bool CameraModel::project(const Eigen::Vector3d& point_camera, Eigen::Vector2d* pixel) const {
  Eigen::Vector2d undistorted;
  return project_undistorted(point_camera, &undistorted) && distort(undistorted, pixel);
}

}  // namespace unisim::geometric
