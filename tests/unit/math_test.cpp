// SPDX-License-Identifier: MIT
// Elementary functions against those of the system.
#include "core/base/math.hpp"

#include <cmath>
#include <limits>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

namespace math = unisim::math;

namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon();
constexpr int kTrials = 20000;

// In units of the last digit of the expected value.
double error(double value, double expected) {
  const double size = std::max(std::abs(expected), std::numeric_limits<double>::min());
  return value == expected ? 0.0 : std::abs(value - expected) / (kUnit * size);
}

}  // namespace

TEST_CASE("exp and expm1 err by two units of the last digit at most") {
  unisim_test::Random random(1);
  double worst = 0.0;
  double worst_m1 = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const double range = i % 3 == 0 ? 700.0 : (i % 3 == 1 ? 1.0 : 1e-6);
    const double x = random.uniform(-range, range);
    worst = std::max(worst, error(math::exp(x), std::exp(x)));
    worst_m1 = std::max(worst_m1, error(math::expm1(x), std::expm1(x)));
  }
  CHECK(worst < 2.0);
  CHECK(worst_m1 < 3.0);
}

TEST_CASE("log errs by two units of the last digit at most") {
  unisim_test::Random random(2);
  double worst = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const double x =
        i % 2 == 0 ? std::exp(random.uniform(-700.0, 700.0)) : random.uniform(0.5, 2.0);
    worst = std::max(worst, error(math::log(x), std::log(x)));
  }
  CHECK(worst < 2.5);
}

TEST_CASE("log of floats is right to their precision") {
  unisim_test::Random random(3);
  for (int i = 0; i < kTrials; ++i) {
    const float x = static_cast<float>(std::exp(random.uniform(-80.0, 80.0)));
    const double expected = std::log(static_cast<double>(x));
    CHECK(std::abs(static_cast<double>(math::log(x)) - expected) <=
          1e-7 * std::abs(expected) + 1e-9);
  }
}

TEST_CASE("sine and cosine are right to two units of the last digit of 1") {
  unisim_test::Random random(4);
  double worst = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const double range = i % 3 == 0 ? 1e4 : (i % 3 == 1 ? 4.0 : 1e-3);
    const double x = random.uniform(-range, range);
    double sine = 0.0;
    double cosine = 0.0;
    math::sin_cos(x, &sine, &cosine);
    worst = std::max(worst, std::abs(sine - std::sin(x)) / kUnit);
    worst = std::max(worst, std::abs(cosine - std::cos(x)) / kUnit);
    if (range < 1e-2) worst = std::max(worst, error(sine, std::sin(x)));
  }
  CHECK(worst < 2.0);
}

TEST_CASE("angles of the first quadrant err by two units of the last digit at most") {
  unisim_test::Random random(5);
  double worst = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const double angle = random.uniform(0.0, 1.5707963);
    const double size = std::exp(random.uniform(-20.0, 20.0));
    const double x = size * std::cos(angle);
    const double y = size * std::sin(angle) * (i % 4 == 0 ? 1e-8 : 1.0);
    worst = std::max(worst, error(math::first_quadrant_angle(x, y), std::atan2(y, x)));
  }
  CHECK(worst < 2.5);
  CHECK(math::first_quadrant_angle(1.0, 0.0) == 0.0);
  CHECK(math::first_quadrant_angle(0.0, 1.0) == Approx(std::acos(0.0)));
}

TEST_CASE("elementary functions at the edges of their range") {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::nan("");
  double s = 0.0;
  double c = 0.0;
  CHECK(math::exp(0.0) == 1.0);
  CHECK(math::exp(710.0) == infinity);
  CHECK(math::exp(-800.0) == 0.0);
  CHECK(math::exp(-740.0) == Approx(std::exp(-740.0)).epsilon(0.1));
  CHECK(std::isnan(math::exp(nan)));
  CHECK(math::log(1.0) == 0.0);
  CHECK(math::log(0.0) == -infinity);
  CHECK(math::log(infinity) == infinity);
  CHECK(std::isnan(math::log(-1.0)));
  CHECK(math::log(5e-320) == Approx(std::log(5e-320)));
  CHECK(math::log(0.0F) == -std::numeric_limits<float>::infinity());
  CHECK(std::isnan(math::log(-1.0F)));
  math::sin_cos(infinity, &s, &c);
  CHECK(std::isnan(s));
  CHECK(std::isnan(c));
  CHECK(std::isnan(math::first_quadrant_angle(nan, 1.0)));
}
