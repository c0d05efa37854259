// SPDX-License-Identifier: MIT
// Huber loss and the robust cost of a bundle adjustment.
#pragma once

#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "drivers/geometric/bundle/bundle_problem.hpp"
#include "drivers/geometric/bundle/reprojection_residual.hpp"

namespace unisim::geometric {

/// What an observation behind its camera costs: as much as this many scaled pixels.
inline constexpr double kBehindResidual = 1000.0;

/// Huber loss of a residual norm: square / 2 up to delta, linear beyond.
inline double huber_cost(double norm, double delta) {
  return norm <= delta ? 0.5 * norm * norm : delta * (norm - 0.5 * delta);
}

/// Weight that makes a quadratic touch the Huber loss at this norm.
inline double huber_weight(double norm, double delta) { return norm <= delta ? 1.0 : delta / norm; }

/// Constants of a pass over the residuals.
ResidualIntrinsics residual_intrinsics(const BundleIntrinsics& intrinsics, double pixel_scale);

/// Robust cost of one point: its observations.
double point_cost(const BundleProblem& problem, const BundlePoint& point,
                  const ResidualIntrinsics& constants, double huber);

/// Cost of the priors on the intrinsics that are free.
double intrinsics_cost(const BundleIntrinsics& intrinsics);

}  // namespace unisim::geometric
