// SPDX-License-Identifier: MIT
// Similarities: worked examples.
#include "core/lie/sim3.hpp"

#include <limits>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::about_z;
using unisim_test::difference;
using unisim_test::kNan;
using unisim_test::kPi;

namespace {}  // namespace

TEST_CASE("a similarity scales, turns and shifts in this order") {
  const Sim3 T = about_z(kPi / 2, 10, 20, 30, 2);
  CHECK(difference(T.act(Vec3(1, 0, 5)), Vec3(10, 22, 40)) < 1e-14);
}

TEST_CASE("the product applies the right factor first") {
  const Sim3 a = about_z(kPi / 2, 1, 0, 0, 2);
  const Sim3 b = about_z(0, 3, 0, 0, 5);
  const Sim3 ab = a * b;
  CHECK(difference(ab.t, Vec3(1, 6, 0)) < 1e-14);
  CHECK(ab.s == Approx(10));
  CHECK(difference(ab.act(Vec3(1, 1, 1)), a.act(b.act(Vec3(1, 1, 1)))) < 1e-13);
}

TEST_CASE("inverse and between undo a transform") {
  const Sim3 a = about_z(0.7, 1, -2, 3, 0.25);
  const Sim3 b = about_z(-1.2, 4, 1, 0, 3);
  CHECK(difference(a * a.inverse(), Sim3()) < 1e-14);
  CHECK(difference(between(a, b), a.inverse() * b) < 1e-13);
}

TEST_CASE("exp of a pure log-scale and translation stretches along the way") {
  Vec7 xi;
  xi << 3, 0, 0, 0, 0, 0, std::log(2.0);
  const Sim3 T = sim3_exp(xi);
  CHECK(T.s == Approx(2.0));
  CHECK(T.t.x() == Approx(3.0 / std::log(2.0)));  // V = (e^sigma - 1) / sigma
  CHECK(difference(sim3_log(T), xi) < 1e-15);
}

TEST_CASE("exp of a rotation and translation walks along an arc") {
  Vec7 xi;
  xi << 1, 0, 0, 0, 0, kPi, 0;
  const Sim3 T = sim3_exp(xi);
  CHECK(difference(T.t, Vec3(0, 2 / kPi, 0)) < 1e-15);  // half a circle of length 1
  CHECK(T.s == 1.0);
}

TEST_CASE("the adjoint of a known transform") {
  const Sim3 T = about_z(kPi / 2, 1, 2, 3, 2);
  Mat7 expected;
  expected << 0, -2, 0, -3, 0, 2, -1,  // [sR, hat(t) R, -t]
      2, 0, 0, 0, -3, -1, -2,          //
      0, 0, 2, 1, 2, 0, -3,            //
      0, 0, 0, 0, -1, 0, 0,            //
      0, 0, 0, 1, 0, 0, 0,             //
      0, 0, 0, 0, 0, 1, 0,             //
      0, 0, 0, 0, 0, 0, 1;
  CHECK(difference(sim3_adjoint(T), expected) < 1e-14);
}

TEST_CASE("Jacobians at zero are the identity") {
  const Vec7 zero = Vec7::Zero();
  CHECK(difference(sim3_left_jacobian(zero), Mat7::Identity()) == 0.0);
  CHECK(difference(sim3_left_jacobian_inverse(zero), Mat7::Identity()) == 0.0);
  CHECK(difference(sim3_right_jacobian(zero), Mat7::Identity()) == 0.0);
}

TEST_CASE("to first order the Jacobian is I + ad / 2") {
  Vec7 xi;
  xi << 1e-6, -2e-6, 3e-6, 2e-6, 1e-6, -1e-6, 4e-6;
  CHECK(difference(sim3_left_jacobian(xi), Mat7::Identity() + 0.5 * sim3_ad(xi)) < 1e-11);
  CHECK(difference(sim3_left_jacobian_inverse(xi), Mat7::Identity() - 0.5 * sim3_ad(xi)) < 1e-11);
  CHECK(difference(sim3_right_jacobian_inverse(xi), Mat7::Identity() + 0.5 * sim3_ad(xi)) < 1e-11);
}

TEST_CASE("valid refuses what is not a similarity") {
  CHECK(Sim3().valid());
  Sim3 T;
  T.s = 0.0;
  CHECK_FALSE(T.valid());
  T.s = -1.0;
  CHECK_FALSE(T.valid());
  T = Sim3();
  T.t.y() = kNan;
  CHECK_FALSE(T.valid());
  T = Sim3();
  T.q = Quat(0.9, 0, 0, 0);
  CHECK_FALSE(T.valid());
  T.q = Quat(kNan, 0, 0, 0);
  CHECK_FALSE(T.valid());
}

TEST_CASE("a million updates leave the rotation a rotation") {
  Vec7 dx;
  dx << 1e-3, 0, 0, 1e-3, -2e-3, 3e-3, 0;
  Sim3 T;
  for (int i = 0; i < 1000000; ++i) T = retract(T, dx);
  const Mat3 R = T.q.toRotationMatrix();
  CHECK(difference(R * R.transpose(), Mat3::Identity()) < 1e-14);
  CHECK(T.valid());
}
