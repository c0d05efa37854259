// SPDX-License-Identifier: MIT
// Residual shared by the pose factors.
#include "core/graph/relative_pose.hpp"

namespace unisim {
Vec7 relative_pose_residual(const Sim3& A, const Sim3& B, const Sim3& P, const Sim3& Q) {
  return sim3_log(between(P, between(A, B) * Q));
}

RelativePoseJacobians relative_pose_jacobians(const Sim3& A, const Sim3& B, const Sim3& P,
                                              const Sim3& Q) {
  RelativePoseJacobians out;
  out.e = relative_pose_residual(A, B, P, Q);
  out.J_e_A = -sim3_left_jacobian_inverse(out.e) * sim3_adjoint(P.inverse());
  out.J_e_B = sim3_right_jacobian_inverse(out.e) * sim3_adjoint(Q.inverse());
  return out;
}

}  // namespace unisim
