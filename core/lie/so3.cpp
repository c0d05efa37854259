// SPDX-License-Identifier: MIT
// Rotations: exponential, logarithm, Jacobians.
#include "core/lie/so3.hpp"

#include <cmath>

#include "core/base/math.hpp"
#include "core/lie/sim3_coefficients.hpp"

namespace unisim {
namespace {

constexpr double kExpSeries = 0.0625;  // theta^2 below which exp needs no trigonometry
constexpr double kLogSeries = 1e-4;    // tan^2(theta/2) below which log needs none

Mat3 polynomial(const Vec3& phi, double b, double c) {
  const Mat3 K = hat(phi);
  Mat3 out = c * phi * phi.transpose() + b * K;  // K^2 = phi phi' - theta^2 I
  out.diagonal().array() += 1.0 - c * phi.squaredNorm();
  return out;
}

}  // namespace

Mat3 hat(const Vec3& v) {
  Mat3 K;
  K << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return K;
}

Quat so3_exp(const Vec3& phi) {
  const double theta2 = phi.squaredNorm();
  double w;
  double k;  // sin(theta / 2) / theta
  if (theta2 < kExpSeries) {
    const double x = 0.25 * theta2;
    w = 1.0 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320 - x / 3628800))));
    k = 0.5 * (1.0 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040 - x * (1.0 / 362880)))));
  } else {
    const double theta = std::sqrt(theta2);
    double sine;
    math::sin_cos(0.5 * theta, &sine, &w);
    k = sine / theta;
  }
  return Quat(w, k * phi.x(), k * phi.y(), k * phi.z());
}

double so3_log_factor(double n2, double w) {
  if (n2 < kLogSeries * w * w) {
    const double r2 = n2 / (w * w);
    return 2.0 / w * (1.0 - r2 * (1.0 / 3 - r2 * (1.0 / 5 - r2 / 7)));
  }
  const double n = std::sqrt(n2);
  const double angle = 2.0 * math::first_quadrant_angle(std::abs(w), n);
  return (w < 0.0 ? -angle : angle) / n;
}

Vec3 so3_log(const Quat& q) {
  const Vec3 v(q.x(), q.y(), q.z());
  return so3_log_factor(v.squaredNorm(), q.w()) * v;
}

Vec3 rotate(const Quat& q, const Vec3& v) {
  const Vec3 u(q.x(), q.y(), q.z());
  const Vec3 twice = 2.0 * u.cross(v);
  return v + q.w() * twice + u.cross(twice);
}

Vec3 rotate_inverse(const Quat& q, const Vec3& v) { return rotate(q.conjugate(), v); }

Mat3 so3_left_jacobian(const Vec3& phi) {
  const ExpCoefficients k = exp_coefficients(phi.squaredNorm(), 0.0);
  return polynomial(phi, k.B, k.C);
}

Mat3 so3_left_jacobian_inverse(const Vec3& phi) {
  return polynomial(phi, -0.5, log_coefficients(phi.squaredNorm(), 0.0).c_rotation);
}

}  // namespace unisim
