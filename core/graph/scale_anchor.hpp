// SPDX-License-Identifier: MIT
// Scale-anchor factor between a submap m and one of its keyframes i.
#pragma once

#include "core/graph/scale_ratio.hpp"

namespace unisim {

// The residual as written, for tests: the solver runs scale_ratio.hpp for both scale factors.

/// e = log s_i - log s_m - log rho_mi, 1 row.
/// @param log_rho_mi log median(D_i in submap m / D_i in its two-view pair)
inline double scale_anchor_residual(const Sim3& T_world_submap, const Sim3& T_world_kf,
                                    double log_rho_mi) {
  return scale_ratio_residual(T_world_submap, T_world_kf, log_rho_mi);
}

}  // namespace unisim
