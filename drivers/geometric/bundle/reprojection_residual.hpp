// SPDX-License-Identifier: MIT
// Reprojection residual of one observation on the undistorted side, with its analytic Jacobians.
#pragma once

#include <Eigen/Core>

#include "drivers/geometric/bundle/bundle_problem.hpp"

namespace unisim::geometric {

/// Constants of the shared intrinsics, worked out once per pass.
struct ResidualIntrinsics {
  double focal;
  double k1;
  double cx;
  double cy;
  double readout;  ///< seconds
  double inverse_focal2;
  double inverse_scale;  ///< 1 / pixel_scale
};

/// log f, k1, cx, cy, readout.
inline constexpr int kIntrinsics = 5;
using IntrinsicsVector = Eigen::Matrix<double, kIntrinsics, 1>;

/// Rows of r = w (f (x/z, y/z) - d (1 + k1 |d|^2 / f^2)), d = pixel - readout * sway - (cx, cy),
/// and of its derivatives. Camera tangent: (translation 3, rotation 3) of retract().
struct ReprojectionResidual {
  Eigen::Vector2d r;
  Eigen::Matrix<double, 6, 1> camera0, camera1;  ///< d r0, d r1 by the camera
  Eigen::Vector3d point0, point1;                ///< by the point in the world
  IntrinsicsVector intrinsics0, intrinsics1;
};

/// r alone, at camera coordinates y with y.z > 0.
inline Eigen::Vector2d reprojection_value(const ResidualIntrinsics& in, const Eigen::Vector3d& y,
                                          const BundleObservation& seen) {
  const double w = seen.weight * in.inverse_scale;
  const Eigen::Vector2d still = seen.still(in.readout);
  const double dx = still.x() - in.cx;
  const double dy = still.y() - in.cy;
  const double stretch = 1.0 + in.k1 * (dx * dx + dy * dy) * in.inverse_focal2;
  const double scale = in.focal / y.z();
  return Eigen::Vector2d(w * (scale * y.x() - dx * stretch), w * (scale * y.y() - dy * stretch));
}

/// Derivatives at y = R X + t, every row times `factor` (the root of a robust weight, and the
/// weight).
inline void reprojection_jacobian(const ResidualIntrinsics& in, const Eigen::Matrix3d& R,
                                  const Eigen::Vector3d& y, const BundleObservation& seen,
                                  double factor, ReprojectionResidual* out) {
  const double iz = 1.0 / y.z();
  const double mx = y.x() * iz;
  const double my = y.y() * iz;
  const double wf = factor * in.inverse_scale * in.focal;
  const double g = wf * iz;
  out->camera0 << g, 0.0, -g * mx, -wf * mx * my, wf * (1.0 + mx * mx), -wf * my;
  out->camera1 << 0.0, g, -g * my, -wf * (1.0 + my * my), wf * mx * my, wf * mx;
  out->point0 = g * (R.row(0) - mx * R.row(2)).transpose();
  out->point1 = g * (R.row(1) - my * R.row(2)).transpose();
  const Eigen::Vector2d still = seen.still(in.readout);
  const double dx = still.x() - in.cx;
  const double dy = still.y() - in.cy;
  const double r2 = (dx * dx + dy * dy) * in.inverse_focal2;
  const double w = factor * in.inverse_scale;
  const double bend = 2.0 * in.k1 * r2;
  const double stretch = w * (1.0 + in.k1 * r2);
  const double twist = 2.0 * w * in.k1 * in.inverse_focal2;
  const double xx = stretch + twist * dx * dx;
  const double xy = twist * dx * dy;
  const double yy = stretch + twist * dy * dy;
  const Eigen::Vector2d& sway = seen.sway;
  out->intrinsics0 << wf * mx + w * bend * dx, -w * dx * r2, xx, xy, xx * sway.x() + xy * sway.y();
  out->intrinsics1 << wf * my + w * bend * dy, -w * dy * r2, xy, yy, xy * sway.x() + yy * sway.y();
}

}  // namespace unisim::geometric
