// SPDX-License-Identifier: MIT
// Similarities: group, exponential, logarithm, adjoint, Jacobians.
//
// The inverse Jacobian comes straight from the logarithm: perturbing T on the left by a rotation d
// moves t by -hat(t) d and phi by J^-1 d, by a log-scale d moves t by t d and sigma by d, so with
// rho = V^-1(phi, sigma) t and D = d(V^-1 t)/dphi
//     J_l^-1 = [[V^-1, D J^-1 - V^-1 hat(t), rho + (dV^-1/dsigma) t], [0, J^-1, 0], [0, 0, 1]].
#include "core/lie/sim3.hpp"

#include <cmath>

#include "core/base/math.hpp"
#include "core/lie/sim3_coefficients.hpp"
#include "core/lie/so3.hpp"

namespace unisim {
namespace {

// One Newton step towards length 1: exact to second order, no square root.
Quat drawn_to_unit(const Quat& q) {
  const double k = 1.5 - 0.5 * q.squaredNorm();
  return Quat(k * q.w(), k * q.x(), k * q.y(), k * q.z());
}

// k0 v + k1 phi x v + k2 phi x (phi x v)
Vec3 apply(const Vec3& phi, double k0, double k1, double k2, const Vec3& v) {
  const Vec3 once = phi.cross(v);
  return k0 * v + k1 * once + k2 * phi.cross(once);
}

// a I + b K + c K^2
Mat3 polynomial(const Vec3& phi, double a, double b, double c) {
  Mat3 out = c * phi * phi.transpose();
  const Vec3 p = b * phi;
  out(0, 1) -= p.z();
  out(1, 0) += p.z();
  out(0, 2) += p.y();
  out(2, 0) -= p.y();
  out(1, 2) -= p.x();
  out(2, 1) += p.x();
  out.diagonal().array() += a - c * phi.squaredNorm();
  return out;
}

// The blocks of J^-1 that are not constant: [[V_inv, X, x], [0, J_inv, 0], [0, 0, 1]].
struct InverseBlocks {
  Mat3 V_inv;
  Mat3 X;
  Mat3 J_inv;
  Vec3 x;
};

// Blocks of J_l^-1 at the logarithm of a transform with translation t.
InverseBlocks left_inverse_blocks(const Vec3& phi, const Vec3& rho, const Vec3& t,
                                  const LogCoefficients& k) {
  InverseBlocks out;
  out.V_inv = polynomial(phi, k.a, k.b, k.c);
  out.J_inv = polynomial(phi, 1.0, -0.5, k.c_rotation);
  const Vec3 once = phi.cross(t);
  const Vec3 twice = phi.cross(once);
  const Vec3 u = k.b_theta * once + k.c_theta * twice - 2.0 * k.c * t;
  Mat3 D = u * phi.transpose() + (k.c * phi) * t.transpose() - k.b * hat(t);
  D.diagonal().array() += k.c * phi.dot(t);
  out.X = D * out.J_inv - out.V_inv * hat(t);
  out.x = rho + k.a_sigma * t + k.b_sigma * once + k.c_sigma * twice;
  return out;
}

Mat7 assemble(const InverseBlocks& blocks) {
  Mat7 J = Mat7::Zero();
  J.topLeftCorner<3, 3>() = blocks.V_inv;
  J.block<3, 3>(0, 3) = blocks.X;
  J.block<3, 1>(0, 6) = blocks.x;
  J.block<3, 3>(3, 3) = blocks.J_inv;
  J(6, 6) = 1.0;
  return J;
}

}  // namespace

Sim3 Sim3::scaling(double factor) {
  Sim3 out;
  out.s = factor;
  return out;
}

Sim3 Sim3::inverse() const {
  Sim3 out;
  out.q = q.conjugate();
  out.s = 1.0 / s;
  out.t = -out.s * rotate(out.q, t);
  return out;
}

Vec3 Sim3::act(const Vec3& p) const { return s * rotate(q, p) + t; }

bool Sim3::valid() const {
  return std::isfinite(s) && s > 0.0 && t.allFinite() && std::abs(q.squaredNorm() - 1.0) < 2e-6;
}

bool Sim3::in_range() const {
  constexpr double kLargest = 1e30;  // no camera sees thirty orders of magnitude
  return valid() && s <= kLargest && s >= 1.0 / kLargest && t.cwiseAbs().maxCoeff() <= kLargest;
}

Sim3 operator*(const Sim3& a, const Sim3& b) {
  Sim3 out;
  out.q = drawn_to_unit(a.q * b.q);
  out.t = a.s * rotate(a.q, b.t) + a.t;
  out.s = a.s * b.s;
  return out;
}

Sim3 between(const Sim3& a, const Sim3& b) {
  const double inv_s = 1.0 / a.s;
  Sim3 out;
  out.q = drawn_to_unit(a.q.conjugate() * b.q);
  out.t = inv_s * rotate_inverse(a.q, b.t - a.t);
  out.s = inv_s * b.s;
  return out;
}

Sim3 sim3_exp(const Vec7& xi) {
  const Vec3 phi = xi.segment<3>(3);
  const double sigma = xi(6);
  const ExpCoefficients k = exp_coefficients(phi.squaredNorm(), sigma);
  Sim3 out;
  out.q = so3_exp(phi);
  out.t = apply(phi, k.A, k.B, k.C, xi.head<3>());
  out.s = math::exp(sigma);
  return out;
}

Vec7 sim3_log(const Sim3& T) {
  const Vec3 phi = so3_log(T.q);
  const double sigma = math::log(T.s);
  const LogCoefficients k = log_coefficients(phi.squaredNorm(), sigma);
  Vec7 xi;
  xi.head<3>() = apply(phi, k.a, k.b, k.c, T.t);
  xi.segment<3>(3) = phi;
  xi(6) = sigma;
  return xi;
}

Sim3 retract(const Sim3& T, const Vec7& dx) { return T * sim3_exp(dx); }

Mat7 sim3_adjoint(const Sim3& T) {
  const Mat3 R = T.q.toRotationMatrix();
  Mat7 Ad = Mat7::Zero();
  Ad.topLeftCorner<3, 3>() = T.s * R;
  Ad.block<3, 3>(0, 3) = hat(T.t) * R;
  Ad.block<3, 1>(0, 6) = -T.t;
  Ad.block<3, 3>(3, 3) = R;
  Ad(6, 6) = 1.0;
  return Ad;
}

Mat7 sim3_ad(const Vec7& xi) {
  Mat7 ad = Mat7::Zero();
  ad.topLeftCorner<3, 3>() = hat(xi.segment<3>(3));
  ad.topLeftCorner<3, 3>().diagonal().array() += xi(6);
  ad.block<3, 3>(0, 3) = hat(xi.head<3>());
  ad.block<3, 1>(0, 6) = -xi.head<3>();
  ad.block<3, 3>(3, 3) = hat(xi.segment<3>(3));
  return ad;
}

Mat7 sim3_left_jacobian_inverse(const Vec7& xi) {
  const Vec3 phi = xi.segment<3>(3);
  const double theta2 = phi.squaredNorm();
  const ExpCoefficients V = exp_coefficients(theta2, xi(6));
  const Vec3 t = apply(phi, V.A, V.B, V.C, xi.head<3>());
  return assemble(left_inverse_blocks(phi, xi.head<3>(), t, log_coefficients(theta2, xi(6))));
}

Mat7 sim3_left_jacobian(const Vec7& xi) {
  const Vec3 phi = xi.segment<3>(3);
  const double theta2 = phi.squaredNorm();
  const ExpCoefficients k = exp_coefficients(theta2, xi(6));
  const Vec3 t = apply(phi, k.A, k.B, k.C, xi.head<3>());
  const InverseBlocks inverse =
      left_inverse_blocks(phi, xi.head<3>(), t, log_coefficients(theta2, xi(6)));
  InverseBlocks out;
  out.V_inv = polynomial(phi, k.A, k.B, k.C);
  out.J_inv = so3_left_jacobian(phi);
  out.X = -out.V_inv * inverse.X * out.J_inv;
  out.x = -out.V_inv * inverse.x;
  return assemble(out);
}

Mat7 sim3_right_jacobian(const Vec7& xi) { return sim3_left_jacobian(-xi); }

Mat7 sim3_right_jacobian_inverse(const Vec7& xi) { return sim3_left_jacobian_inverse(-xi); }

}  // namespace unisim
