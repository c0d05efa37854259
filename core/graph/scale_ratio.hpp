// SPDX-License-Identifier: MIT
// Residual shared by the scale factors: e = log s_B - log s_A - c.
#pragma once

#include "core/base/math.hpp"
#include "core/lie/sim3.hpp"

namespace unisim {

/// e = log s_B - log s_A - c, 1 row. Its Jacobian is -1 on the log-scale of A and +1 on that of B,
/// exact for right perturbations; all other entries are zero.
inline double scale_ratio_residual(const Sim3& A, const Sim3& B, double c) {
  return math::log(B.s / A.s) - c;
}

}  // namespace unisim
