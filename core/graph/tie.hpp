// SPDX-License-Identifier: MIT
// Tie factor between two submaps m and n that share keyframe i.
#pragma once

#include "core/graph/relative_pose.hpp"

namespace unisim {

/// P = T_submap_m_kf Scale(c_i): keyframe i in submap m, in the unit of submap n.
/// @param T_submap_m_kf prediction in submap m, scale 1
/// @param c_i           median(D_i in submap m / D_i in submap n)
inline Sim3 tie_measurement(const Sim3& T_submap_m_kf, double c_i) {
  return T_submap_m_kf * Sim3::scaling(c_i);
}

// Residual and Jacobians as written, for tests: the solver runs relative_pose_pack.hpp.

/// e = log((T_world_m P)^-1 T_world_n T_submap_n_kf), 7 rows.
inline Vec7 tie_residual(const Sim3& T_world_m, const Sim3& T_world_n, const Sim3& P,
                         const Sim3& T_submap_n_kf) {
  return relative_pose_residual(T_world_m, T_world_n, P, T_submap_n_kf);
}

/// Jacobians for right perturbations of T_world_m (A) and T_world_n (B).
inline RelativePoseJacobians tie_jacobians(const Sim3& T_world_m, const Sim3& T_world_n,
                                           const Sim3& P, const Sim3& T_submap_n_kf) {
  return relative_pose_jacobians(T_world_m, T_world_n, P, T_submap_n_kf);
}

}  // namespace unisim
