// SPDX-License-Identifier: MIT
// Rotations: exponential, logarithm, Jacobians.
#pragma once

#include "core/base/eigen_types.hpp"

namespace unisim {

/// Cross-product matrix: hat(a) b = a x b.
Mat3 hat(const Vec3& v);

/// Unit quaternion of the rotation vector phi [rad].
Quat so3_exp(const Vec3& phi);

/// Rotation vector of a unit quaternion, |phi| <= pi; q and -q give the same, stable up to pi.
Vec3 so3_log(const Quat& q);

/// Factor from the vector part of a unit quaternion to so3_log(); n2: square of that part's norm.
double so3_log_factor(double n2, double w);

/// q v q*: two cross products, no matrix.
Vec3 rotate(const Quat& q, const Vec3& v);

/// R* v.
Vec3 rotate_inverse(const Quat& q, const Vec3& v);

/// J_l(phi) = sum K^n / (n+1)!, 3x3; the right Jacobian is J_l(-phi).
Mat3 so3_left_jacobian(const Vec3& phi);

/// Inverse of so3_left_jacobian() for |phi| < 2 pi.
Mat3 so3_left_jacobian_inverse(const Vec3& phi);

}  // namespace unisim
