// SPDX-License-Identifier: MIT
// Coefficients of the matrix functions against their definition in complex numbers.
#include "core/lie/sim3_coefficients.hpp"

#include <complex>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using Complex = std::complex<long double>;

namespace {

Complex g(Complex z) { return z / (std::exp(z) - 1.0L); }
Complex g_prime(Complex z) { return g(z) * (1.0L - z - g(z)) / z; }
long double g_real(long double sigma) { return sigma / std::expm1(sigma); }
long double g_prime_real(long double sigma) {
  return g_real(sigma) * (1.0L - sigma - g_real(sigma)) / sigma;
}

double relative(double value, long double expected) {
  return static_cast<double>(std::abs(value - expected) / (1e-3L + std::abs(expected)));
}

}  // namespace

TEST_CASE("log coefficients match z / (e^z - 1) on all branches") {
  // theta around the switch at |z|^2 = 0.01 and 0.5, and up to pi; sigma from -2 to 3
  for (const long double theta :
       {0.0999L, 0.1001L, 0.4999L, 0.5001L, 0.707L, 0.7072L, 1.5L, 3.1415L}) {
    for (const long double sigma :
         {-2.0L, -0.7L, -0.1001L, -0.0999L, 0.001L, 0.0999L, 0.1001L, 0.7L, 0.7072L, 3.0L}) {
      CAPTURE(static_cast<double>(theta), static_cast<double>(sigma));
      const LogCoefficients k =
          log_coefficients(static_cast<double>(theta * theta), static_cast<double>(sigma));
      const Complex z(sigma, theta);
      const long double real = g_real(sigma);
      const long double slope = g_prime_real(sigma);
      const long double x = theta * theta;
      const long double b = g(z).imag() / theta;
      const long double c = (real - g(z).real()) / x;
      CHECK(relative(k.a, real) < 1e-12);
      CHECK(relative(k.b, b) < 1e-12);
      CHECK(relative(k.c, c) < 1e-12);
      CHECK(relative(k.a_sigma, slope) < 1e-12);
      CHECK(relative(k.b_sigma, g_prime(z).imag() / theta) < 1e-12);
      CHECK(relative(k.c_sigma, (slope - g_prime(z).real()) / x) < 1e-11);
      CHECK(relative(k.b_theta, (g_prime(z).real() - b) / x) < 1e-11);
      CHECK(relative(k.c_theta, (g_prime(z).imag() / theta - 2.0L * c) / x) < 1e-11);
    }
  }
}

TEST_CASE("log coefficients at zero") {
  const LogCoefficients k = log_coefficients(0.0, 0.0);
  CHECK(k.a == 1.0);
  CHECK(k.b == -0.5);
  CHECK(k.c == Approx(1.0 / 12));
  CHECK(k.c_rotation == Approx(1.0 / 12));
  CHECK(k.a_sigma == -0.5);
  CHECK(k.b_sigma == Approx(1.0 / 6));
  CHECK(k.c_sigma == Approx(0.0).margin(1e-16));
  CHECK(k.b_theta == Approx(0.0).margin(1e-16));
  CHECK(k.c_theta == Approx(1.0 / 360));
}

TEST_CASE("exp coefficients match (e^z - 1) / z on both branches") {
  for (const long double theta : {0.05L, 0.4999L, 0.5001L, 0.707L, 0.7072L, 3.1415L}) {
    for (const long double sigma : {-2.0L, -0.5L, 0.001L, 0.5L, 0.7072L, 3.0L}) {
      const ExpCoefficients k =
          exp_coefficients(static_cast<double>(theta * theta), static_cast<double>(sigma));
      const Complex z(sigma, theta);
      const Complex psi = (std::exp(z) - 1.0L) / z;
      const long double real = (std::exp(sigma) - 1.0L) / sigma;
      CHECK(relative(k.A, real) < 1e-13);
      CHECK(relative(k.B, psi.imag() / theta) < 1e-13);
      CHECK(relative(k.C, (real - psi.real()) / (theta * theta)) < 1e-13);
    }
  }
}

TEST_CASE("angle terms agree on both sides of their series") {
  const AngleTerms below = angle_terms(0.25 * (1.0 - 1e-12));
  const AngleTerms above = angle_terms(0.25);
  CHECK(std::abs(below.cosine - above.cosine) < 1e-12);
  CHECK(std::abs(below.sinc - above.sinc) < 1e-12);
  CHECK(std::abs(below.versine - above.versine) < 1e-12);
  CHECK(std::abs(below.d_sinc - above.d_sinc) < 1e-12);
  CHECK(std::abs(below.d_versine - above.d_versine) < 1e-12);
  CHECK(above.cosine == Approx(std::cos(0.5)));
  CHECK(angle_terms(0.0).d_sinc == Approx(-1.0 / 3));
  CHECK(angle_terms(0.0).d_versine == Approx(-1.0 / 12));
}
