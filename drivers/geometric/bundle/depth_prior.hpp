// SPDX-License-Identifier: MIT
// Gaussian prior on the inverse depth of a point seen from one camera, with its analytic Jacobians.
#pragma once

#include <Eigen/Core>

namespace unisim::geometric {

/// r = (1 / z - inverse_depth) / sigma with z the depth in the camera, and derivatives.
struct DepthPrior {
  double r;
  Eigen::Matrix<double, 6, 1> camera;  ///< tangent (translation 3, rotation 3) of retract()
  Eigen::Vector3d point;               ///< in the world
};

/// At camera coordinates y = R X + t, y.z > 0.
inline DepthPrior depth_prior(const Eigen::Matrix3d& R, const Eigen::Vector3d& y,
                              double inverse_depth, double sigma) {
  const double iz = 1.0 / y.z();
  const double slope = -iz * iz / sigma;
  DepthPrior out;
  out.r = (iz - inverse_depth) / sigma;
  out.camera << 0.0, 0.0, slope, slope * y.y(), -slope * y.x(), 0.0;
  out.point = slope * R.row(2).transpose();
  return out;
}

}  // namespace unisim::geometric
