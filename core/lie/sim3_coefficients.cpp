// SPDX-License-Identifier: MIT
// Scalar coefficients of the matrix functions of sigma I + hat(phi).
//
// Two forms each: power series of z = sigma + i theta where |z| is small, closed forms elsewhere.
// The closed forms are written with angle_terms() so that nothing is divided by theta, and their
// other divisor |e^z - 1|^2 is far from zero outside the range of the series.
#include "core/lie/sim3_coefficients.hpp"

#include <cmath>

#include "core/base/math.hpp"

namespace unisim {
namespace {

constexpr double kAngleSeries = 0.25;   // theta^2 below which angle_terms() sums a series
constexpr double kZSeries = 0.5;        // |z|^2 below which the power series are summed
constexpr double kZShortSeries = 0.01;  // |z|^2 below which half the terms suffice
constexpr int kAngleTerms = 8;
constexpr int kExpTerms = 20;
constexpr int kExpShortTerms = 10;
constexpr int kBernoulliTerms = 10;
constexpr int kBernoulliShortTerms = 5;

// B_2k / (2k)!: g(z) = 1 - z/2 + sum_k beta_k z^2k.
constexpr double kBeta[kBernoulliTerms] = {1.0 / 12,
                                           -1.0 / 720,
                                           1.0 / 30240,
                                           -1.0 / 1209600,
                                           1.0 / 47900160,
                                           -691.0 / 1307674368000.0,
                                           1.0 / 74724249600.0,
                                           -3617.0 / 10670622842880000.0,
                                           43867.0 / 5109094217170944000.0,
                                           -174611.0 / 802857662698291200000.0};

// Powers z^n in real form: re = Re z^n, im = Im z^n / theta, gap = (sigma^n - Re z^n) / theta^2,
// all polynomials in sigma and theta^2.
struct Power {
  double re;
  double im;
  double gap;
};

Power times_z(const Power& p, double theta2, double sigma) {
  return {sigma * p.re - theta2 * p.im, p.re + sigma * p.im, sigma * p.gap + p.im};
}

// 1 / (n + 1)!.
struct Reciprocals {
  constexpr Reciprocals() {
    double factorial = 1.0;
    for (int n = 0; n < kExpTerms; ++n) {
      factorial *= n + 1;
      of_factorial[n] = 1.0 / factorial;
    }
  }
  double of_factorial[kExpTerms] = {};
};
constexpr Reciprocals kReciprocals;

ExpCoefficients exp_series(double theta2, double sigma, int terms) {
  Power p{1.0, 0.0, 0.0};
  ExpCoefficients out{1.0, 0.0, 0.0};
  for (int n = 1; n < terms; ++n) {
    p = times_z(p, theta2, sigma);
    const double k = kReciprocals.of_factorial[n];
    out.A += k * (p.re + theta2 * p.gap);
    out.B += k * p.im;
    out.C += k * p.gap;
  }
  return out;
}

// c of J_so3^-1 by its series in theta^2 (Bernoulli numbers again).
double rotation_series(double theta2, int terms) {
  double c = 0.0;
  for (int k = terms - 1; k >= 0; --k) c = kBeta[k] - theta2 * c;
  return c;
}

LogCoefficients log_series(double theta2, double sigma, int terms) {
  const double w_re = sigma * sigma - theta2;  // w = z^2
  const double w_im = 2.0 * sigma;
  const double sigma2 = sigma * sigma;
  Power even{1.0, 0.0, 0.0};             // w^(k-1), then w^k
  double re_x = 0, im_x = 0, gap_x = 0;  // their derivatives by theta^2
  LogCoefficients out{1.0 - 0.5 * sigma, -0.5, 0.0, -0.5, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (int k = 1; k <= terms; ++k) {
    const double beta = kBeta[k - 1];
    const double slope = 2.0 * k * beta;
    const Power odd = times_z(even, theta2, sigma);
    out.a_sigma += slope * (odd.re + theta2 * odd.gap);
    out.b_sigma += slope * odd.im;
    out.c_sigma += slope * odd.gap;
    const double next_gap_x = sigma2 * gap_x + re_x + w_im * im_x;
    const double next_re_x = re_x * w_re - even.re - w_im * (even.im + theta2 * im_x);
    const double next_im_x = re_x * w_im + im_x * w_re - even.im;
    even = times_z(odd, theta2, sigma);
    re_x = next_re_x;
    im_x = next_im_x;
    gap_x = next_gap_x;
    out.a += beta * (even.re + theta2 * even.gap);
    out.b += beta * even.im;
    out.c += beta * even.gap;
    out.b_theta += 2.0 * beta * im_x;
    out.c_theta += 2.0 * beta * gap_x;
  }
  out.c_rotation = rotation_series(theta2, terms);
  return out;
}

LogCoefficients log_closed(double theta2, double sigma) {
  const AngleTerms angle = angle_terms(theta2);
  const double E = math::exp(sigma);
  const double E1 = math::expm1(sigma);
  const double versine2 = theta2 * angle.versine;               // 1 - cos
  const double inv_den = 1.0 / (E1 * E1 + 2.0 * E * versine2);  // 1 / |e^z - 1|^2
  const double den_sigma = 2.0 * E * (E1 + versine2);
  const double den_theta = 2.0 * E * angle.sinc;
  LogCoefficients out;
  if (sigma * sigma < kZShortSeries) {
    const LogCoefficients real = log_series(0.0, sigma, kBernoulliShortTerms);
    out.a = real.a;
    out.a_sigma = real.a_sigma;
  } else {
    out.a = sigma / E1;
    out.a_sigma = out.a * (1.0 - sigma - out.a) / sigma;
  }
  const double b_num = E * angle.cosine - 1.0 - sigma * E * angle.sinc;
  out.b = b_num * inv_den;
  out.b_sigma = (E * (angle.cosine - (1.0 + sigma) * angle.sinc) - out.b * den_sigma) * inv_den;
  out.b_theta = (-E * angle.sinc - sigma * E * angle.d_sinc - out.b * den_theta) * inv_den;
  const double c_num = E * (out.a * (E + 1.0) * angle.versine - angle.sinc);
  out.c = c_num * inv_den;
  out.c_sigma =
      (c_num + E * (out.a_sigma * (E + 1.0) + out.a * E) * angle.versine - out.c * den_sigma) *
      inv_den;
  out.c_theta =
      (E * (out.a * (E + 1.0) * angle.d_versine - angle.d_sinc) - out.c * den_theta) * inv_den;
  out.c_rotation = theta2 < kZSeries ? rotation_series(theta2, kBernoulliTerms)
                                     : (1.0 - 0.5 * angle.sinc / angle.versine) / theta2;
  return out;
}

}  // namespace

AngleTerms angle_terms(double theta2) {
  if (theta2 >= kAngleSeries) {
    const double theta = std::sqrt(theta2);
    double half;  // sine and cosine of theta / 2
    double half_cosine;
    math::sin_cos(0.5 * theta, &half, &half_cosine);
    const double sinc = 2.0 * half * half_cosine / theta;
    const double versine = 2.0 * half * half / theta2;
    const double cosine = 1.0 - 2.0 * half * half;
    return {cosine, sinc, versine, (cosine - sinc) / theta2, (sinc - 2.0 * versine) / theta2};
  }
  AngleTerms out{0.0, 1.0, 0.5, 0.0, 0.0};
  double term = 1.0;  // (-theta2)^k / (2k)!
  double before = 1.0;
  for (int k = 1; k <= kAngleTerms; ++k) {
    const double n = 2.0 * k;
    const double d_term = -before / ((n - 1.0) * n);  // term / theta2
    term = theta2 * d_term;
    out.sinc += term / (n + 1.0);
    out.versine += term / ((n + 1.0) * (n + 2.0));
    out.d_sinc += n * d_term / (n + 1.0);
    out.d_versine += n * d_term / ((n + 1.0) * (n + 2.0));
    before = term;
  }
  out.cosine = 1.0 - theta2 * out.versine;
  return out;
}

ExpCoefficients exp_coefficients(double theta2, double sigma) {
  const double z2 = theta2 + sigma * sigma;
  if (z2 < kZShortSeries) return exp_series(theta2, sigma, kExpShortTerms);
  if (z2 < kZSeries) return exp_series(theta2, sigma, kExpTerms);
  const AngleTerms angle = angle_terms(theta2);
  const double E = math::exp(sigma);
  const double E1 = math::expm1(sigma);
  const double A = std::abs(sigma) < 1e-8 ? 1.0 + 0.5 * sigma : E1 / sigma;
  const double B = (sigma * E * angle.sinc - E1 + E * theta2 * angle.versine) / z2;
  const double C = (A + sigma * E * angle.versine - E * angle.sinc) / z2;
  return {A, B, C};
}

LogCoefficients log_coefficients(double theta2, double sigma) {
  const double z2 = theta2 + sigma * sigma;
  if (z2 < kZShortSeries) return log_series(theta2, sigma, kBernoulliShortTerms);
  if (z2 < kZSeries) return log_series(theta2, sigma, kBernoulliTerms);
  return log_closed(theta2, sigma);
}

}  // namespace unisim
