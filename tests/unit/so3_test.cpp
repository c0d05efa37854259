// SPDX-License-Identifier: MIT
// Rotations: worked examples.
#include "core/lie/so3.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::difference;
using unisim_test::kPi;

namespace {}

TEST_CASE("hat is the cross product") {
  const Vec3 a(1, 2, 3);
  const Vec3 b(-4, 5, 0.5);
  CHECK(difference(hat(a) * b, a.cross(b)) == 0.0);
}

TEST_CASE("a quarter turn about z takes x to y") {
  const Quat q = so3_exp(Vec3(0, 0, kPi / 2));
  CHECK(difference(rotate(q, Vec3(1, 0, 0)), Vec3(0, 1, 0)) < 1e-15);
  CHECK(difference(rotate_inverse(q, Vec3(0, 1, 0)), Vec3(1, 0, 0)) < 1e-15);
  CHECK(difference(so3_log(q), Vec3(0, 0, kPi / 2)) < 1e-15);
}

TEST_CASE("q and -q have the same logarithm") {
  const Quat q = so3_exp(Vec3(0.3, -0.7, 0.2));
  const Quat minus(-q.w(), -q.x(), -q.y(), -q.z());
  CHECK(difference(so3_log(q), so3_log(minus)) < 1e-15);
  const Quat small(-1.0, -1e-7, 0.0, 0.0);
  CHECK(difference(so3_log(small), Vec3(2e-7, 0, 0)) < 1e-20);
}

TEST_CASE("half a turn has a logarithm of length pi") {
  CHECK(so3_log(Quat(0, 1, 0, 0)).x() == Approx(kPi));
  CHECK(so3_log(Quat(0, 0, 0.6, 0.8)).norm() == Approx(kPi));
}

TEST_CASE("exp and log agree on both sides of their series") {
  for (const double angle : {0.0, 1e-12, 1e-8, 0.009999, 0.010001, 0.019998, 0.020002, 0.5, 3.1}) {
    const Vec3 phi = angle * Vec3(2, -1, 2) / 3.0;
    const Quat q = so3_exp(phi);
    CHECK(std::abs(q.norm() - 1.0) < 1e-15);
    CHECK(std::abs(2.0 * std::atan2(q.vec().norm(), q.w()) - angle) < 1e-15);
    CHECK(difference(so3_log(q), phi) < 2e-15);
  }
}

TEST_CASE("the left Jacobian of half a turn about z") {
  // J = sin(t)/t I + (1 - sin(t)/t) a a' + (1 - cos(t))/t hat(a), t = pi, a = z
  Mat3 expected;
  expected << 0, -2 / kPi, 0, 2 / kPi, 0, 0, 0, 0, 1;
  CHECK(difference(so3_left_jacobian(Vec3(0, 0, kPi)), expected) < 1e-15);
  CHECK(difference(so3_left_jacobian_inverse(Vec3(0, 0, kPi)) * expected, Mat3::Identity()) <
        1e-15);
}
