// SPDX-License-Identifier: MIT
// Residual shared by the pose factors: e = log((A P)^-1 (B Q)).
#pragma once

#include "core/lie/sim3.hpp"

namespace unisim {

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

/// Symmetric 7x7 matrix by blocks of the tangent (translation, rotation, log-scale):
/// [[tt, tr, ts], [tr', rr, rs], [ts', rs', ss]].
struct SymmetricBlocks {
  Mat3 tt;
  Mat3 tr;
  Mat3 rr;
  Vec3 ts;
  Vec3 rs;
  double ss;
};

/// Squared residual as a quadratic form of the perturbations, for weight 1.
struct RelativePoseNormal {
  Vec7 e;
  SymmetricBlocks H_bb;  ///< J_e_B' J_e_B
  SymmetricBlocks H_aa;  ///< J_e_A' J_e_A
  Mat7 H_ba;             ///< J_e_B' J_e_A
  Vec7 g_b;              ///< J_e_B' e
  Vec7 g_a;              ///< J_e_A' e
};

/// The products of relative_pose_jacobians() without forming the Jacobians.
///
/// With D = A^-1 B, J_e_A = -J_e_B Ad(D^-1): one sandwich of H_bb with Ad(D^-1) gives H_ba and
/// H_aa.
/// @param Q nullptr: identity, which saves a sandwich
void relative_pose_normal(const Sim3& A, const Sim3& B, const Sim3& P, const Sim3* Q,
                          RelativePoseNormal* out);

}  // namespace unisim
