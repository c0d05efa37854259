// SPDX-License-Identifier: MIT
// Rigid factor: the relative pose of g2o's EDGE_SE3:QUAT, for graphs on SE(3).
#pragma once

#include "core/lie/sim3.hpp"

namespace unisim {

using Vec6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
using Mat6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

/// e = (translation, vector part of the quaternion with w >= 0) of Z_a_b^-1 T_world_a^-1 T_world_b,
/// 6 rows; all three have scale 1. Its cost is that of u, u^2 = e' Lambda e.
inline Vec6 rigid_residual(const Sim3& T_world_a, const Sim3& T_world_b, const Sim3& Z_a_b) {
  const Sim3 E = between(Z_a_b, between(T_world_a, T_world_b));
  Vec6 e;
  e.head<3>() = E.t;
  e.tail<3>() = (E.q.w() < 0.0 ? -1.0 : 1.0) * Vec3(E.q.x(), E.q.y(), E.q.z());
  return e;
}

/// Residual and its 6x6 Jacobians for right perturbations (translation, rotation) of a and b:
/// J_e_b = [[R_E, 0], [0, (|w| I + hat(e_r)) / 2]], J_e_a = -J_e_b Ad(T_world_b^-1 T_world_a).
struct RigidJacobians {
  Vec6 e;
  Mat6 J_e_a;
  Mat6 J_e_b;
};
RigidJacobians rigid_jacobians(const Sim3& T_world_a, const Sim3& T_world_b, const Sim3& Z_a_b);

}  // namespace unisim
