// SPDX-License-Identifier: MIT
// Rigid factor.
#include "core/graph/rigid.hpp"

#include <cmath>

#include "core/lie/so3.hpp"

namespace unisim {

RigidJacobians rigid_jacobians(const Sim3& T_world_a, const Sim3& T_world_b, const Sim3& Z_a_b) {
  const Sim3 D = between(T_world_a, T_world_b);
  const Sim3 E = between(Z_a_b, D);
  RigidJacobians out;
  out.e = rigid_residual(T_world_a, T_world_b, Z_a_b);
  out.J_e_b.setZero();
  out.J_e_b.topLeftCorner<3, 3>() = E.q.toRotationMatrix();
  out.J_e_b.bottomRightCorner<3, 3>() =
      0.5 * (std::abs(E.q.w()) * Mat3::Identity() + hat(out.e.tail<3>()));
  out.J_e_a = -out.J_e_b * sim3_adjoint(D.inverse()).topLeftCorner<6, 6>();
  return out;
}

}  // namespace unisim
