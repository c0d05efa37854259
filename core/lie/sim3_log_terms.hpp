// SPDX-License-Identifier: MIT
// What the logarithm of one similarity is built from, for files that do without Eigen.
#pragma once

#include "core/lie/sim3_coefficients.hpp"

namespace unisim {

/// Rotation vector phi = angle_factor * (x, y, z) of the quaternion, log-scale sigma and the
/// coefficients of the two.
struct Sim3LogTerms {
  double angle_factor;
  double sigma;
  LogCoefficients coefficients;
};

/// @param x, y, z, w unit quaternion of the rotation, any sign
/// @param s          scale
void sim3_log_terms(double x, double y, double z, double w, double s, Sim3LogTerms* out);

}  // namespace unisim
