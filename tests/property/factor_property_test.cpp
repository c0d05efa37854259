// SPDX-License-Identifier: MIT
// Every factor's Jacobians against central differences, small and large residuals.
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
using unisim_test::difference;
using unisim_test::numeric_jacobian;
using unisim_test::Random;

namespace {

// Poses and measurements whose residual has about the given angle and log-scale.
struct Case {
  Case(Random& random, double angle, double log_scale)
      : A(random.pose(3.0, 3.0, 1.0)),
        P(random.pose(2.0, 2.0, 0.5)),
        Q(random.pose(2.0, 2.0, 0.5)),
        error(sim3_exp(random.tangent(0.5, angle, log_scale))) {}
  Sim3 A, P, Q, error;
};

template <class Residual>
void check_jacobians(const RelativePoseJacobians& J, const Sim3& A, const Sim3& B,
                     Residual residual) {
  const auto of_A = [&](const Sim3& at) -> Eigen::VectorXd { return residual(at, B); };
  const auto of_B = [&](const Sim3& at) -> Eigen::VectorXd { return residual(A, at); };
  const double scale = 1.0 + J.J_e_A.cwiseAbs().maxCoeff() + J.J_e_B.cwiseAbs().maxCoeff();
  CHECK(difference(J.J_e_A, numeric_jacobian(A, of_A)) < 1e-9 * scale);
  CHECK(difference(J.J_e_B, numeric_jacobian(B, of_B)) < 1e-9 * scale);
  CHECK(difference(J.e, residual(A, B)) == 0.0);
}

template <class Check>
void for_all_cases(Check check) {
  Random random(21);
  for (const double angle : {0.0, 1e-9, 1e-3, 0.09, 0.11, 0.4, 0.6, 0.8, 2.0, 2.9}) {
    for (const double log_scale : {-1.0, -0.1, 0.0, 1e-6, 0.3, 1.0}) {
      CAPTURE(angle, log_scale);
      check(Case(random, angle, log_scale));
    }
  }
}

}  // namespace

TEST_CASE("Jacobians of two_view") {
  for_all_cases([](const Case& c) {
    const Sim3 B = c.A * c.P * c.error;
    check_jacobians(two_view_jacobians(c.A, B, c.P), c.A, B,
                    [&](const Sim3& i, const Sim3& j) { return two_view_residual(i, j, c.P); });
  });
}

TEST_CASE("Jacobians of bridge") {
  for_all_cases([](const Case& c) {
    const Sim3 B = c.A * c.P * c.error;
    check_jacobians(bridge_jacobians(c.A, B, c.P), c.A, B,
                    [&](const Sim3& m, const Sim3& i) { return bridge_residual(m, i, c.P); });
  });
}

TEST_CASE("Jacobians of tie") {
  for_all_cases([](const Case& c) {
    const Sim3 B = c.A * c.P * c.error * c.Q.inverse();
    check_jacobians(tie_jacobians(c.A, B, c.P, c.Q), c.A, B,
                    [&](const Sim3& m, const Sim3& n) { return tie_residual(m, n, c.P, c.Q); });
  });
}

TEST_CASE("Jacobians of the scale factors are -1 and +1 on the log-scale") {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Sim3 A = random.pose(3.0, 3.0, 2.0);
    const Sim3 B = random.pose(3.0, 3.0, 2.0);
    const auto anchor_of_A = [&](const Sim3& at) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, scale_anchor_residual(at, B, 0.3));
    };
    const auto scale_of_B = [&](const Sim3& at) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, scale_residual(A, at, 0.3));
    };
    const auto metric_of_A = [&](const Sim3& at) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, metric_residual(at, B, 0.3));
    };
    const auto metric_of_B = [&](const Sim3& at) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, metric_residual(A, at, 0.3));
    };
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(1, 7);
    expected(0, 6) = -1.0;
    CHECK(difference(numeric_jacobian(A, metric_of_A), expected) < 1e-11);
    CHECK(difference(numeric_jacobian(B, metric_of_B), -expected) < 1e-11);
    CHECK(difference(numeric_jacobian(A, anchor_of_A), expected) < 1e-11);
    CHECK(difference(numeric_jacobian(B, scale_of_B), -expected) < 1e-11);
  }
}

TEST_CASE("Jacobians of rigid") {
  Random random(31);
  for (const double angle : {0.0, 1e-9, 1e-3, 0.4, 2.0, 2.9, 3.5, 5.0}) {
    CAPTURE(angle);
    const Sim3 A = random.pose(3.0, 3.0, 0.0);
    const Sim3 Z = random.pose(2.0, 2.0, 0.0);
    const Sim3 B = A * Z * sim3_exp(random.tangent(0.5, angle, 0.0));
    const auto of_A = [&](const Sim3& at) -> Eigen::VectorXd { return rigid_residual(at, B, Z); };
    const auto of_B = [&](const Sim3& at) -> Eigen::VectorXd { return rigid_residual(A, at, Z); };
    const RigidJacobians J = rigid_jacobians(A, B, Z);
    CHECK(difference(J.J_e_a, numeric_jacobian(A, of_A).leftCols<6>()) < 1e-9);
    CHECK(difference(J.J_e_b, numeric_jacobian(B, of_B).leftCols<6>()) < 1e-9);
    CHECK(difference(J.e, rigid_residual(A, B, Z)) == 0.0);
  }
}
