// SPDX-License-Identifier: MIT
// Scale factor between two submaps m and n that share keyframes.
#pragma once

#include "core/graph/scale_ratio.hpp"

namespace unisim {

// The residual as written, for tests: the solver runs scale_ratio.hpp for both scale factors.

/// e = log s_n - log s_m - log c, 1 row.
/// @param log_c log median over shared keyframes i of median(D_i in submap m / D_i in submap n)
inline double scale_residual(const Sim3& T_world_m, const Sim3& T_world_n, double log_c) {
  return scale_ratio_residual(T_world_m, T_world_n, log_c);
}

}  // namespace unisim
