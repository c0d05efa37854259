// SPDX-License-Identifier: MIT
// Exp, log, Jacobians and factors against the stored numbers of the reference.
#include "core/graph/relative_pose.hpp"
#include "tests/golden/stored.hpp"
#include "tests/support/catch.hpp"

using namespace unisim;
using unisim_test::difference;

TEST_CASE("exp, log and Jacobians equal the reference") {
  const auto lines = unisim_test::stored_lines("lie.txt");
  REQUIRE(lines.size() == 40);
  for (const auto& line : lines) {
    unisim_test::Numbers numbers(line);
    const Vec7 xi = numbers.vector();
    const Sim3 T = numbers.pose();
    const Mat7 J_left = numbers.matrix();
    const Mat7 J_left_inverse = numbers.matrix();
    CAPTURE(xi.transpose());
    // The reference states 2e-13 for exp, 2e-9 for log next to half a turn, 2e-12 and 2e-11 for the
    // Jacobians; all of them grow with the size of the numbers.
    CHECK(difference(sim3_exp(xi), T) < 2e-13 * (1.0 + T.s + T.t.norm()));
    const bool near_half_turn = xi.segment<3>(3).norm() > 3.1;
    CHECK(difference(sim3_log(T), xi) < (near_half_turn ? 2e-9 : 1e-11));
    CHECK(difference(sim3_left_jacobian(xi), J_left) < 2e-12 * (1.0 + J_left.norm()));
    CHECK(difference(sim3_left_jacobian_inverse(xi), J_left_inverse) <
          2e-11 * (1.0 + J_left_inverse.norm()));
  }
}

TEST_CASE("residuals and Jacobians of the pose factors equal the reference") {
  const auto lines = unisim_test::stored_lines("factors.txt");
  REQUIRE(lines.size() == 24);
  for (const auto& line : lines) {
    unisim_test::Numbers numbers(line);
    const Sim3 A = numbers.pose();
    const Sim3 B = numbers.pose();
    const Sim3 P = numbers.pose();
    const Sim3 Q = numbers.pose();
    const Vec7 e = numbers.vector();
    const Mat7 J_e_A = numbers.matrix();
    const Mat7 J_e_B = numbers.matrix();
    const RelativePoseJacobians J = relative_pose_jacobians(A, B, P, Q);
    // 1e-11 of the numbers' size: roundoff of the stored poses, carried through the inverses
    CHECK(difference(J.e, e) < 1e-11 * (1.0 + e.norm()));
    CHECK(difference(J.J_e_A, J_e_A) < 1e-11 * (1.0 + J_e_A.norm()));
    CHECK(difference(J.J_e_B, J_e_B) < 1e-11 * (1.0 + J_e_B.norm()));
  }
}
