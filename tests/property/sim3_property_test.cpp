// SPDX-License-Identifier: MIT
// Group laws, exp and log, Jacobians of Sim(3) over the whole range of angles and scales.
#include "core/lie/sim3.hpp"
#include "core/lie/so3.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::difference;
using unisim_test::Random;

namespace {

const double kPi = std::acos(-1.0);
// Both sides of every branch point, and the ends of the range.
const double kAngles[] = {0.0,  1e-12,  1e-6,   0.00999, 0.01001, 0.0199, 0.0201,     0.0999,
                          0.15, 0.4999, 0.5001, 0.7071,  0.7072,  2.0,    kPi - 1e-4, kPi - 1e-7};
const double kLogScales[] = {-2.0, -0.70711, -0.70710, -0.1001, -0.0999, -1e-9, 0.0,
                             1e-7, 0.0999,   0.1001,   0.5,     0.70711, 3.0};

template <class Check>
void for_all_tangents(Check check) {
  Random random(7);
  for (const double angle : kAngles) {
    for (const double log_scale : kLogScales) {
      CAPTURE(angle, log_scale);
      check(random.tangent(2.0, angle, log_scale));
    }
  }
}

double size(const Sim3& T) { return 1.0 + T.t.norm() + T.s; }

}  // namespace

TEST_CASE("products are associative, inverses undo, between divides") {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Sim3 a = random.pose(5.0, 3.1, 2.0);
    const Sim3 b = random.pose(5.0, 3.1, 2.0);
    const Sim3 c = random.pose(5.0, 3.1, 2.0);
    CHECK(difference((a * b) * c, a * (b * c)) < 1e-14 * size(a * b * c) * size(a));
    CHECK(difference(a * a.inverse(), Sim3()) < 1e-13 * size(a));
    CHECK(difference(a * between(a, b), b) < 1e-13 * size(a) * size(b));
    const Vec3 p = random.vector(3.0);
    CHECK(difference((a * b).act(p), a.act(b.act(p))) < 1e-13 * size(a) * size(b));
  }
}

TEST_CASE("log undoes exp and exp undoes log") {
  for_all_tangents([](const Vec7& xi) {
    const Sim3 T = sim3_exp(xi);
    // Near half a turn the axis may flip and with it phi: there the transforms are compared.
    if (xi.segment<3>(3).norm() < kPi - 1e-3) CHECK(difference(sim3_log(T), xi) < 1e-12);
    CHECK(difference(sim3_exp(sim3_log(T)), T) < 1e-13 * size(T));
    CHECK(difference(sim3_exp(-xi), T.inverse()) < 1e-13 * size(T.inverse()));
  });
}

TEST_CASE("exp of the double is the square") {
  for_all_tangents([](const Vec7& xi) {
    const Sim3 half = sim3_exp(0.5 * xi);
    CHECK(difference(half * half, sim3_exp(xi)) < 1e-13 * size(sim3_exp(xi)));
  });
}

TEST_CASE("the adjoint moves a perturbation through") {
  Random random(3);
  for_all_tangents([&](const Vec7& xi) {
    const Sim3 T = random.pose(2.0, 3.0, 1.0);
    const Vec7 small = 0.1 * xi;
    const Sim3 moved = T * sim3_exp(small) * T.inverse();
    CHECK(difference(moved, sim3_exp(sim3_adjoint(T) * small)) < 1e-12 * size(T) * size(moved));
  });
}

TEST_CASE("the adjoint is a homomorphism and exp of ad") {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Sim3 a = random.pose(2.0, 3.0, 1.0);
    const Sim3 b = random.pose(2.0, 3.0, 1.0);
    const double scale = size(a) * size(b);
    CHECK(difference(sim3_adjoint(a * b), sim3_adjoint(a) * sim3_adjoint(b)) < 1e-13 * scale);
  }
}

TEST_CASE("Jacobians and their inverses multiply to the identity") {
  for_all_tangents([](const Vec7& xi) {
    const Mat7 left = sim3_left_jacobian(xi) * sim3_left_jacobian_inverse(xi);
    const Mat7 right = sim3_right_jacobian(xi) * sim3_right_jacobian_inverse(xi);
    CHECK(difference(left, Mat7::Identity()) < 1e-11);
    CHECK(difference(right, Mat7::Identity()) < 1e-11);
  });
}

TEST_CASE("left and right Jacobians differ by the adjoint") {
  for_all_tangents([](const Vec7& xi) {
    const Mat7 left = sim3_left_jacobian(xi);
    const Mat7 right = sim3_right_jacobian(xi);
    const double scale = 1.0 + right.cwiseAbs().maxCoeff() * size(sim3_exp(xi));
    CHECK(difference(left, sim3_adjoint(sim3_exp(xi)) * right) < 1e-12 * scale);
  });
}

TEST_CASE("the right Jacobian inverse is the derivative of log") {
  for_all_tangents([](const Vec7& xi) {
    if (xi.segment<3>(3).norm() > 3.1) return;  // the difference quotient would cross pi
    const Sim3 T = sim3_exp(xi);
    const Eigen::MatrixXd numeric = unisim_test::numeric_jacobian(
        T, [](const Sim3& at) -> Eigen::VectorXd { return sim3_log(at); });
    const Mat7 J = sim3_right_jacobian_inverse(xi);
    CHECK(difference(J, numeric) < 1e-9 * (1.0 + J.cwiseAbs().maxCoeff()));
  });
}

TEST_CASE("rotations: exp, log and Jacobian over the whole range") {
  Random random(9);
  for (const double angle : kAngles) {
    const Vec3 phi = angle * random.direction();
    const Quat q = so3_exp(phi);
    CHECK(std::abs(q.norm() - 1.0) < 1e-15);
    if (angle < kPi - 1e-3) CHECK(difference(so3_log(q), phi) < 1e-14);
    const Mat3 product = so3_left_jacobian(phi) * so3_left_jacobian_inverse(phi);
    CHECK(difference(product, Mat3::Identity()) < 1e-14);
    const Vec3 v = random.vector(2.0);
    CHECK(difference(rotate(q, v), q.toRotationMatrix() * v) < 1e-14);
    CHECK(difference(rotate_inverse(q, rotate(q, v)), v) < 1e-14);
  }
}
