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

// With D = A^-1 B, J_e_A = -J_e_B Ad(D^-1): one sandwich of H_bb gives the other two blocks.
void chain_normal(const Sim3& T_world_a, const Sim3& T_world_b, const ChainLink& link,
                  ChainNormal* out) {
  const Sim3 D = between(T_world_a, T_world_b);
  Vec7 e;
  Sim3JacobianInverse M;
  sim3_log_with_jacobian(between(link.Z_a_b, D), &e, &M);
  Mat7 J_b = Mat7::Identity();
  J_b.topLeftCorner<3, 3>() = M.V_inv;
  J_b.block<3, 3>(0, 3) = M.X;
  J_b.block<3, 1>(0, 6) = M.x;
  J_b.block<3, 3>(3, 3) = M.J_inv;
  const Mat7 Ad = sim3_adjoint(D.inverse());
  const Vec7 Lambda_e = link.Lambda * e;
  out->u_squared = e.dot(Lambda_e);
  out->g_b.noalias() = J_b.transpose() * Lambda_e;
  out->g_a.noalias() = -(Ad.transpose() * out->g_b);
  Mat7 Lambda_J_b;
  Lambda_J_b.noalias() = link.Lambda * J_b;
  out->H_bb.noalias() = J_b.transpose() * Lambda_J_b;
  out->H_ba.noalias() = -(out->H_bb * Ad);
  out->H_aa.noalias() = -(Ad.transpose() * out->H_ba);
}

}  // namespace unisim
