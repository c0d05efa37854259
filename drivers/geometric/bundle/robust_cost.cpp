// SPDX-License-Identifier: MIT
// Huber loss and the robust cost of a bundle adjustment.
#include "drivers/geometric/bundle/robust_cost.hpp"

#include <cmath>

namespace unisim::geometric {
namespace {

double gaussian_cost(double value, double mean, double sigma) {
  if (!(sigma > 0.0)) return 0.0;
  const double r = (value - mean) / sigma;
  return 0.5 * r * r;
}

}  // namespace

ResidualIntrinsics residual_intrinsics(const BundleIntrinsics& intrinsics, double pixel_scale) {
  const double focal = std::exp(intrinsics.log_focal);
  return {focal,
          intrinsics.k1,
          intrinsics.cx,
          intrinsics.cy,
          intrinsics.readout_s,
          1.0 / (focal * focal),
          1.0 / pixel_scale};
}

double point_cost(const BundleProblem& problem, const BundlePoint& point,
                  const ResidualIntrinsics& constants, double huber) {
  double cost = 0.0;
  for (int o = point.first; o < point.first + point.count; ++o) {
    const BundleObservation& seen = problem.observation(o);
    if (!(seen.weight > 0.0)) continue;
    const Eigen::Vector3d y = problem.camera(seen.camera).pose.apply(point.position);
    if (!(y.z() > kMinDepth)) {
      cost += huber_cost(kBehindResidual * seen.weight, huber);
      continue;
    }
    cost += huber_cost(reprojection_value(constants, y, seen).norm(), huber);
  }
  return cost;
}

double intrinsics_cost(const BundleIntrinsics& in) {
  double cost = 0.0;
  if (in.free_focal) cost += gaussian_cost(in.log_focal, in.log_focal_mean, in.log_focal_sigma);
  if (in.free_k1) cost += gaussian_cost(in.k1, in.k1_mean, in.k1_sigma);
  if (in.free_center) {
    cost += gaussian_cost(in.cx, in.cx_mean, in.center_sigma_px);
    cost += gaussian_cost(in.cy, in.cy_mean, in.center_sigma_px);
  }
  if (in.free_readout) {
    cost += gaussian_cost(in.readout_s, in.readout_mean_s, in.readout_sigma_s);
  }
  return cost;
}

}  // namespace unisim::geometric
