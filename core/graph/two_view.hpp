// SPDX-License-Identifier: MIT
// Two-view factor between consecutive keyframes i and j.
#pragma once

#include "core/graph/relative_pose.hpp"

namespace unisim {

/// Z_i_j = Scale(r_i) T_i_j: the predicted pose with the depth ratio that ties the unit of pair (i,
/// j) to the unit of keyframe i.
/// @param T_i_j prediction, frame j into frame i, scale 1
/// @param r_i   median(D_i in pair (i-1, i) / D_i in pair (i, j)), 1 for the first pair
inline Sim3 two_view_measurement(const Sim3& T_i_j, double r_i) {
  return Sim3::scaling(r_i) * T_i_j;
}

// Residual and Jacobians as written, for tests: the solver runs relative_pose_pack.hpp.

/// e = log(Z_i_j^-1 T_world_i^-1 T_world_j), 7 rows.
inline Vec7 two_view_residual(const Sim3& T_world_i, const Sim3& T_world_j, const Sim3& Z_i_j) {
  return relative_pose_residual(T_world_i, T_world_j, Z_i_j, Sim3());
}

/// Jacobians for right perturbations of T_world_i (A) and T_world_j (B).
inline RelativePoseJacobians two_view_jacobians(const Sim3& T_world_i, const Sim3& T_world_j,
                                                const Sim3& Z_i_j) {
  return relative_pose_jacobians(T_world_i, T_world_j, Z_i_j, Sim3());
}

}  // namespace unisim
