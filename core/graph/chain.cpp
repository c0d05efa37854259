// SPDX-License-Identifier: MIT
// Chain factor.
#include "core/graph/chain.hpp"

#include <Eigen/Cholesky>

#include "core/graph/relative_pose.hpp"

namespace unisim {

bool valid_link(const ChainLink& link) {
  if (!link.Z_a_b.valid() || !link.Lambda.allFinite()) return false;
  constexpr double kSymmetry = 1e-9;
  const double size = link.Lambda.cwiseAbs().maxCoeff();
  const double skew = (link.Lambda - link.Lambda.transpose()).cwiseAbs().maxCoeff();
  return skew <= kSymmetry * size && link.Lambda.llt().info() == Eigen::Success;
}

Vec7 chain_residual(const Sim3& T_world_a, const Sim3& T_world_b, const Sim3& Z_a_b) {
  return relative_pose_residual(T_world_a, T_world_b, Z_a_b, Sim3());
}

void chain_normal(const Sim3& T_world_a, const Sim3& T_world_b, const ChainLink& link,
                  ChainNormal* out) {
  const RelativePoseJacobians J = relative_pose_jacobians(T_world_a, T_world_b, link.Z_a_b, Sim3());
  const Mat7 Lambda_J_a = link.Lambda * J.J_e_A;
  const Mat7 Lambda_J_b = link.Lambda * J.J_e_B;
  const Vec7 Lambda_e = link.Lambda * J.e;
  out->u_squared = J.e.dot(Lambda_e);
  out->H_aa = J.J_e_A.transpose() * Lambda_J_a;
  out->H_ba = J.J_e_B.transpose() * Lambda_J_a;
  out->H_bb = J.J_e_B.transpose() * Lambda_J_b;
  out->g_a = J.J_e_A.transpose() * Lambda_e;
  out->g_b = J.J_e_B.transpose() * Lambda_e;
}

}  // namespace unisim
