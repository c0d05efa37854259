// SPDX-License-Identifier: MIT
// Robust kernels by name: cost rho(u) of a whitened norm u and the weight of its quadratic
// stand-in.
#pragma once

#include <cstdint>

namespace unisim {

enum class RobustKernelKind : uint8_t { kNone, kHuber, kGemanMcClure };

struct RobustKernel {
  RobustKernelKind kind = RobustKernelKind::kNone;
  double delta = 1.0;  ///< width, on the whitened norm, > 0
};

/// rho(u) and the IRLS weight rho'(u) / u.
struct RobustCost {
  double cost;
  double weight;
};

/// @param u_squared square of the whitened norm u = sqrt(w) |e|
RobustCost robust_cost(const RobustKernel& kernel, double u_squared);

/// The IRLS weight where the cost is rho(u) = `cost`.
double robust_weight(const RobustKernel& kernel, double cost);

}  // namespace unisim
