// SPDX-License-Identifier: MIT
// Residual shared by the pose factors: e = log((A P)^-1 (B Q)).
#pragma once

#include "core/lie/sim3.hpp"

namespace unisim {

// Residuals and Jacobians here and in the factors' own files are the formulas as written, for tests
// and single edges. The solver linearises with relative_pose_pack.hpp, four edges at a time;
// tests/unit/pose_quad_test.cpp holds the two against each other.

/// e = log((A P)^-1 (B Q)), 7 rows. A, B: node poses; P, Q: measured constants.
Vec7 relative_pose_residual(const Sim3& A, const Sim3& B, const Sim3& P, const Sim3& Q);

/// Residual and its 7x7 Jacobians for right perturbations of A and B:
/// J_e_A = -J_l^-1(e) Ad(P^-1), J_e_B = J_r^-1(e) Ad(Q^-1).
struct RelativePoseJacobians {
  Vec7 e;
  Mat7 J_e_A;
  Mat7 J_e_B;
};
RelativePoseJacobians relative_pose_jacobians(const Sim3& A, const Sim3& B, const Sim3& P,
                                              const Sim3& Q);

}  // namespace unisim
