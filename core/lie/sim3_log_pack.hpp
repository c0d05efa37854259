// SPDX-License-Identifier: MIT
// Logarithm of a similarity per lane and its inverse Jacobian, for vectorised sources.
//
// Residuals are small, so power series of z = sigma + i theta serve: with w = z^2 and
// F(w) = sum_k beta_k w^(k-1), E(w) = sum_k k beta_k w^(k-1),
//     g(z) = z / (e^z - 1) = 1 - z / 2 + w F,  g'(z) = -1 / 2 + 2 z E.
// Lanes outside their range (about half a radian or a factor 4/3) take the closed forms of
// sim3_log_terms() one by one. What a lane gets does not depend on its neighbours.
#pragma once

#include "core/lie/sim3_log_terms.hpp"
#include "core/lie/sim3_pack.hpp"

namespace unisim {
namespace UNISIM_ISA {

struct PackTangent {
  Pack3 rho;
  Pack3 phi;
  Pack sigma;
};

/// Blocks of J_r^-1 that are not constant: [[V_inv, X, x], [0, J_inv, 0], [0, 0, 1]].
struct PackJacobianInverse {
  Pack33 V_inv;
  Pack33 X;
  Pack33 J_inv;
  Pack3 x;
  Pack33 V_square;  ///< V_inv' V_inv
  Pack33 J_square;  ///< J_inv' J_inv
};

/// As LogCoefficients.
struct PackLogCoefficients {
  Pack a, b, c;
  Pack a_sigma, b_sigma, c_sigma;
  Pack b_theta, c_theta;
  Pack c_rotation;
};

inline constexpr double kTan2Range = 0.0625;   // tan^2(theta / 2) up to which atan is summed
inline constexpr double kScaleLow = 0.75;      // scales between which log is summed
inline constexpr double kScaleHigh = 4.0 / 3;  // |z|^2 stays below 0.33
inline constexpr int kAtanTerms = 13;
inline constexpr int kAtanhTerms = 10;
inline constexpr int kPackBernoulliTerms = 7;
inline constexpr double kPackBeta[kPackBernoulliTerms] = {
    1.0 / 12,           -1.0 / 720,     1.0 / 30240,
    -1.0 / 1209600,     1.0 / 47900160, -691.0 / 1307674368000.0,
    1.0 / 74724249600.0};

/// atan(r) / r from r^2.
UNISIM_ALWAYS_INLINE Pack atan_series(Pack r2) {
  Pack sum = splat(1.0 / (2 * kAtanTerms - 1));
  for (int k = kAtanTerms - 2; k >= 0; --k) sum = 1.0 / (2 * k + 1) - r2 * sum;
  return sum;
}

/// atanh(y) / y from y^2.
UNISIM_ALWAYS_INLINE Pack atanh_series(Pack y2) {
  Pack sum = splat(1.0 / (2 * kAtanhTerms - 1));
  for (int k = kAtanhTerms - 2; k >= 0; --k) sum = 1.0 / (2 * k + 1) + y2 * sum;
  return sum;
}

/// Coefficients by the series; divisions by theta^2 lose digits only in terms that are multiplied
/// by it.
UNISIM_ALWAYS_INLINE PackLogCoefficients log_series(Pack theta2, Pack sigma) {
  constexpr double kTiny = 1e-40;
  const Pack sigma2 = sigma * sigma;
  const Pack p = sigma2 - theta2;  // w = p + i q, q = 2 sigma theta
  const Pack q2 = 4.0 * sigma2 * theta2;
  Pack F_re = splat(0.0), F_im = splat(0.0);  // F = F_re + i q F_im
  Pack E_re = splat(0.0), E_im = splat(0.0);
  Pack gap = splat(0.0);     // (F(sigma^2) - F_re) / theta^2
  Pack E_real = splat(0.0);  // E(sigma^2)
  Pack rotation = splat(0.0);
  for (int k = kPackBernoulliTerms; k >= 1; --k) {
    const double beta = kPackBeta[k - 1];
    gap = sigma2 * gap + F_re + 4.0 * sigma2 * F_im;
    const Pack F_next = beta + p * F_re - q2 * F_im;
    F_im = F_re + p * F_im;
    F_re = F_next;
    const Pack E_next = (k * beta) + p * E_re - q2 * E_im;
    E_im = E_re + p * E_im;
    E_re = E_next;
    E_real = (k * beta) + sigma2 * E_real;
    rotation = beta - theta2 * rotation;
  }
  const Pack inv_theta2 = 1.0 / select(splat(kTiny) < theta2, theta2, splat(kTiny));
  const Pack E_z = E_re - 2.0 * theta2 * E_im;  // Re(z E) / sigma
  const Pack F_z = F_re + p * F_im;
  PackLogCoefficients k;
  k.a = 1.0 - 0.5 * sigma + sigma2 * (F_re + theta2 * gap);
  k.b = 2.0 * sigma * F_z - 0.5;
  k.c = F_re + 4.0 * sigma2 * F_im + sigma2 * gap;
  k.a_sigma = 2.0 * sigma * E_real - 0.5;
  k.b_sigma = 2.0 * (E_re + 2.0 * sigma2 * E_im);
  k.c_sigma = 2.0 * sigma * (E_real - E_z) * inv_theta2;
  k.b_theta = 2.0 * sigma * (E_z - F_z) * inv_theta2;
  k.c_theta = (k.b_sigma - 2.0 * k.c) * inv_theta2;
  k.c_rotation = rotation;
  return k;
}

/// Lanes that are not in the range of the series, by the closed forms.
UNISIM_ALWAYS_INLINE void replace_lanes(PackMask in_range, const PackQuat& q, Pack s,
                                        Pack* angle_factor, Pack* sigma, PackLogCoefficients* k) {
  for (int lane = 0; lane < kPackLanes; ++lane) {
    if (in_range[lane] != 0) continue;
    Sim3LogTerms terms;
    sim3_log_terms(q.x[lane], q.y[lane], q.z[lane], q.w[lane], s[lane], &terms);
    (*angle_factor)[lane] = terms.angle_factor;
    (*sigma)[lane] = terms.sigma;
    k->a[lane] = terms.coefficients.a;
    k->b[lane] = terms.coefficients.b;
    k->c[lane] = terms.coefficients.c;
    k->a_sigma[lane] = terms.coefficients.a_sigma;
    k->b_sigma[lane] = terms.coefficients.b_sigma;
    k->c_sigma[lane] = terms.coefficients.c_sigma;
    k->b_theta[lane] = terms.coefficients.b_theta;
    k->c_theta[lane] = terms.coefficients.c_theta;
    k->c_rotation[lane] = terms.coefficients.c_rotation;
  }
}

/// a I + b K + c K^2.
UNISIM_ALWAYS_INLINE Pack33 polynomial(const Pack3& phi, Pack theta2, Pack a, Pack b, Pack c) {
  return plus_diagonal(plus_hat(square(c * phi, phi), b * phi), a - c * theta2);
}

/// M' M for M = a I + b K + c K^2: K' = -K and K^4 = -theta^2 K^2 leave a^2 I + k K^2.
UNISIM_ALWAYS_INLINE Pack33 polynomial_square(const Pack3& phi, Pack theta2, Pack a, Pack b,
                                              Pack c) {
  const Pack k = 2.0 * a * c - b * b - c * c * theta2;
  return plus_diagonal(square(k * phi, phi), a * a - k * theta2);
}

/// Logarithm e of T and the blocks of J_r^-1(e) = J_l^-1(e) + ad(e), J_l^-1 as in sim3.cpp.
UNISIM_ALWAYS_INLINE void log_with_jacobian(const PackSim3& T, PackTangent* e,
                                            PackJacobianInverse* M) {
  const Pack3 v = vector_part(T.q);
  const Pack r2 = dot(v, v) / (T.q.w * T.q.w);
  const Pack y = (T.s - 1.0) / (T.s + 1.0);
  Pack angle_factor = 2.0 / T.q.w * atan_series(r2);
  Pack sigma = 2.0 * y * atanh_series(y * y);
  PackLogCoefficients k = log_series(angle_factor * angle_factor * dot(v, v), sigma);
  const PackMask in_range =
      (r2 < splat(kTan2Range)) & (splat(kScaleLow) < T.s) & (T.s < splat(kScaleHigh));
  if (!all(in_range)) replace_lanes(in_range, T.q, T.s, &angle_factor, &sigma, &k);

  const Pack3 phi = angle_factor * v;
  const Pack theta2 = dot(phi, phi);
  const Pack3 once = cross(phi, T.t);
  const Pack3 twice = cross(phi, once);
  e->rho = k.a * T.t + k.b * once + k.c * twice;
  e->phi = phi;
  e->sigma = sigma;

  const Pack33 V_left = polynomial(phi, theta2, k.a, k.b, k.c);
  const Pack33 J_left = polynomial(phi, theta2, splat(1.0), splat(-0.5), k.c_rotation);
  const Pack3 u = k.b_theta * once + k.c_theta * twice - (2.0 * k.c) * T.t;
  const Pack33 D = plus_diagonal(plus_hat(outer(u, phi) + outer(k.c * phi, T.t), -k.b * T.t),
                                 k.c * dot(phi, T.t));
  M->V_inv = plus_diagonal(plus_hat(V_left, phi), sigma);
  M->X = plus_hat(times(D, J_left) - times_hat(V_left, T.t), e->rho);
  M->J_inv = plus_hat(J_left, phi);
  M->V_square = polynomial_square(phi, theta2, k.a + sigma, k.b + 1.0, k.c);
  M->J_square = polynomial_square(phi, theta2, splat(1.0), splat(0.5), k.c_rotation);
  M->x = k.a_sigma * T.t + k.b_sigma * once + k.c_sigma * twice;
}

}  // namespace UNISIM_ISA
}  // namespace unisim
