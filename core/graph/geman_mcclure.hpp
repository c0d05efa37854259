// SPDX-License-Identifier: MIT
// Geman-McClure kernel: bounded cost, so a false measurement loses its pull.
#pragma once

#include "core/graph/robust_kernel.hpp"

namespace unisim {

/// rho(u) = u^2/2 / (1 + u^2/delta^2), at most delta^2/2.
inline RobustCost geman_mcclure(double u_squared, double delta) {
  const double g = 1.0 / (1.0 + u_squared / (delta * delta));
  return {0.5 * u_squared * g, g * g};
}

}  // namespace unisim
