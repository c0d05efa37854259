// SPDX-License-Identifier: MIT
// Bridge factor between a submap m and one of its keyframes i.
#pragma once

#include "core/graph/relative_pose.hpp"

namespace unisim {

/// Z_m_i = T_submap_kf Scale(rho_mi): the predicted pose in submap m with the depth ratio between
/// the submap's unit and the keyframe's.
/// @param T_submap_kf prediction, scale 1
/// @param rho_mi      median(D_i in submap m / D_i in its two-view pair)
inline Sim3 bridge_measurement(const Sim3& T_submap_kf, double rho_mi) {
  return T_submap_kf * Sim3::scaling(rho_mi);
}

// Residual and Jacobians as written, for tests: the solver runs relative_pose_pack.hpp.

/// e = log(Z_m_i^-1 T_world_submap^-1 T_world_kf), 7 rows.
inline Vec7 bridge_residual(const Sim3& T_world_submap, const Sim3& T_world_kf, const Sim3& Z_m_i) {
  return relative_pose_residual(T_world_submap, T_world_kf, Z_m_i, Sim3());
}

/// Jacobians for right perturbations of T_world_submap (A) and T_world_kf (B).
inline RelativePoseJacobians bridge_jacobians(const Sim3& T_world_submap, const Sim3& T_world_kf,
                                              const Sim3& Z_m_i) {
  return relative_pose_jacobians(T_world_submap, T_world_kf, Z_m_i, Sim3());
}

}  // namespace unisim
