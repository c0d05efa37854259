// SPDX-License-Identifier: MIT
// Huber kernel: quadratic up to delta, linear beyond.
#pragma once

#include <cmath>

#include "core/graph/robust_kernel.hpp"

namespace unisim {

/// rho(u) = u^2/2 for u <= delta, else delta (u - delta/2).
inline RobustCost huber(double u_squared, double delta) {
  if (u_squared <= delta * delta) return {0.5 * u_squared, 1.0};
  const double u = std::sqrt(u_squared);
  return {delta * (u - 0.5 * delta), delta / u};
}

}  // namespace unisim
