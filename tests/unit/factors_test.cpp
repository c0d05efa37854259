// SPDX-License-Identifier: MIT
// The five factors: zero where the formula says so, and one hand-computed residual each.
#include "core/graph/bridge.hpp"
#include "core/graph/metric.hpp"
#include "core/graph/rigid.hpp"
#include "core/graph/scale.hpp"
#include "core/graph/scale_anchor.hpp"
#include "core/graph/tie.hpp"
#include "core/graph/two_view.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::about_z;
using unisim_test::difference;

namespace {

// A scene: keyframe i sees it in unit 1/s_i of the world, submaps m and n in units of their own.
struct World {
  Sim3 kf_i = about_z(0.4, 1, 2, 3, 2.0);
  Sim3 kf_j = about_z(0.9, 2, 2, 1, 3.0);
  Sim3 submap_m = about_z(-0.3, 0, 1, 0, 0.5);
  Sim3 submap_n = about_z(1.3, 4, 1, 0, 0.8);
};

// What a predictor says: pose with scale 1 in the unit of the reference frame.
Sim3 predicted(const Sim3& reference, const Sim3& frame) {
  Sim3 T = between(reference, frame);
  T.s = 1.0;
  return T;
}

}  // namespace

TEST_CASE("a two-view measurement with its depth ratio has no residual") {
  const World w;
  // The pair's own unit: that of keyframe j. A length d of the world is d / 3 in it, d / 2 in
  // keyframe i's.
  const Sim3 in_unit_of_i = predicted(w.kf_i, w.kf_j);
  Sim3 T_i_j = in_unit_of_i;
  T_i_j.t *= 2.0 / 3.0;
  const double r_i = 3.0 / 2.0;  // depth in the previous pair over depth in this one
  const Sim3 Z = two_view_measurement(T_i_j, r_i);
  CHECK(Z.s == Approx(1.5));
  CHECK(two_view_residual(w.kf_i, w.kf_j, Z).norm() < 1e-14);
}

TEST_CASE("a bridge measurement with its depth ratio has no residual") {
  const World w;
  const double rho = w.kf_i.s / w.submap_m.s;  // s_i / s_m
  const Sim3 Z = bridge_measurement(predicted(w.submap_m, w.kf_i), rho);
  CHECK(bridge_residual(w.submap_m, w.kf_i, Z).norm() < 1e-14);
  CHECK(std::abs(scale_anchor_residual(w.submap_m, w.kf_i, std::log(rho))) < 1e-15);
}

TEST_CASE("a tie measurement with its depth ratio has no residual") {
  const World w;
  const double c = w.submap_n.s / w.submap_m.s;  // depth in m over depth in n
  const Sim3 P = tie_measurement(predicted(w.submap_m, w.kf_i), c);
  const Sim3 Q = predicted(w.submap_n, w.kf_i);
  CHECK(tie_residual(w.submap_m, w.submap_n, P, Q).norm() < 1e-14);
  CHECK(std::abs(scale_residual(w.submap_m, w.submap_n, std::log(c))) < 1e-15);
}

TEST_CASE("two-view residual of a pure shift is the shift in keyframe i's unit") {
  const Sim3 T_i = about_z(0, 1, 0, 0, 2);
  const Sim3 T_j = about_z(0, 5, 0, 0, 2);
  Vec7 expected = Vec7::Zero();
  expected(0) = 2.0;
  CHECK(difference(two_view_residual(T_i, T_j, Sim3()), expected) < 1e-15);
}

TEST_CASE("bridge residual of a pure scale error is its logarithm") {
  const Sim3 submap = about_z(0.2, 1, 2, 3, 1);
  const Sim3 kf = submap * Sim3::scaling(2.0);
  const Vec7 e = bridge_residual(submap, kf, Sim3());
  CHECK(e.head<6>().norm() < 1e-15);
  CHECK(e(6) == Approx(std::log(2.0)));
}

TEST_CASE("tie residual of a rotation error is its angle") {
  const Sim3 m;
  const Sim3 n = about_z(0.3, 0, 0, 0, 1);
  Vec7 expected = Vec7::Zero();
  expected(5) = 0.3;
  CHECK(difference(tie_residual(m, n, Sim3(), Sim3()), expected) < 1e-15);
}

TEST_CASE("scale residuals are differences of logarithms") {
  const Sim3 a = Sim3::scaling(2.0);
  const Sim3 b = Sim3::scaling(6.0);
  CHECK(scale_anchor_residual(a, b, 0.1) == Approx(std::log(3.0) - 0.1));
  CHECK(scale_residual(b, a, 0.0) == Approx(-std::log(3.0)));
}

TEST_CASE("a submap whose unit is known in metres has no residual against the metre") {
  const World w;
  // A metre is 4 of the world's units long, a unit of submap m half a unit: an eighth of a metre.
  const Sim3 metre = Sim3::scaling(4.0);
  CHECK(std::abs(metric_residual(metre, w.submap_m, std::log(0.125))) < 1e-15);
  CHECK(metric_residual(metre, w.submap_m, std::log(0.25)) == Approx(-std::log(2.0)));
  CHECK(log_metres_per_unit(2.0, {1, 0, 0}, {1, 4, 0}) == Approx(std::log(0.5)));
}

TEST_CASE("a rigid residual is the shift and half the rotation, of the quaternion with w >= 0") {
  const Sim3 a = about_z(0.3, 1, 0, 0, 1);
  const Sim3 Z = about_z(0.2, 0, 1, 0, 1);
  Sim3 b = a * Z * about_z(0.5, 1, 2, 3, 1);
  Vec6 expected;
  expected << 1, 2, 3, 0, 0, std::sin(0.25);
  CHECK(difference(rigid_residual(a, b, Z), expected) < 1e-15);
  b.q.coeffs() *= -1.0;
  CHECK(difference(rigid_residual(a, b, Z), expected) < 1e-15);
}
