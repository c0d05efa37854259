// SPDX-License-Identifier: MIT
// Similarities p' = s R p + t: group, exponential, logarithm, adjoint, Jacobians.
#pragma once

#include "core/base/eigen_types.hpp"

namespace unisim {

/// Similarity transform, 64 bytes. T_a_b takes points of b to a.
/// Tangent order translation 3, rotation 3, log-scale 1:
/// exp(xi) = exp [[sigma I + hat(phi), rho], [0, 0]]; updates act on the right.
struct Sim3 {
  Quat q{1.0, 0.0, 0.0, 0.0};  ///< rotation, unit (stored x y z w; constructor takes w first)
  Vec3 t{0.0, 0.0, 0.0};       ///< translation
  double s{1.0};               ///< scale, > 0

  /// Pure scaling by a factor > 0.
  static Sim3 scaling(double factor);
  Sim3 inverse() const;
  Vec3 act(const Vec3& p) const;
  /// Entries finite, scale positive, quaternion of length 1 within 1e-6.
  bool valid() const;
  /// Valid, and lengths so far from the ends of the range of numbers that products of several such
  /// transforms and their inverses are valid too.
  bool in_range() const;
};
static_assert(sizeof(Sim3) == 64, "one cache line");

/// a b. The quaternion of the product is drawn back to length 1, so chains of any length stay
/// rotations.
Sim3 operator*(const Sim3& a, const Sim3& b);

/// a^-1 b without forming the inverse.
Sim3 between(const Sim3& a, const Sim3& b);

Sim3 sim3_exp(const Vec7& xi);

/// Logarithm for rotations up to pi.
Vec7 sim3_log(const Sim3& T);

/// T exp(dx).
Sim3 retract(const Sim3& T, const Vec7& dx);

/// Ad(T) = [[sR, hat(t) R, -t], [0, R, 0], [0, 0, 1]]: T exp(xi) T^-1 = exp(Ad(T) xi).
Mat7 sim3_adjoint(const Sim3& T);

/// ad(xi) = [[hat(phi) + sigma I, hat(rho), -rho], [0, hat(phi), 0], [0, 0, 0]].
Mat7 sim3_ad(const Vec7& xi);

/// J_l(xi): exp(xi + d) = exp(J_l d) exp(xi) to first order.
Mat7 sim3_left_jacobian(const Vec7& xi);
Mat7 sim3_left_jacobian_inverse(const Vec7& xi);

/// J_r(xi) = J_l(-xi): exp(xi + d) = exp(xi) exp(J_r d) to first order.
Mat7 sim3_right_jacobian(const Vec7& xi);
Mat7 sim3_right_jacobian_inverse(const Vec7& xi);

}  // namespace unisim
