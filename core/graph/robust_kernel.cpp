// SPDX-License-Identifier: MIT
// Robust kernels by name.
#include "core/graph/robust_kernel.hpp"

#include "core/graph/geman_mcclure.hpp"
#include "core/graph/huber.hpp"

namespace unisim {

RobustCost robust_cost(const RobustKernel& kernel, double u_squared) {
  switch (kernel.kind) {
    case RobustKernelKind::kHuber:
      return huber(u_squared, kernel.delta);
    case RobustKernelKind::kGemanMcClure:
      return geman_mcclure(u_squared, kernel.delta);
    case RobustKernelKind::kNone:
      break;
  }
  return {0.5 * u_squared, 1.0};
}

double robust_weight(const RobustKernel& kernel, double cost) {
  const double relative = 2.0 * cost / (kernel.delta * kernel.delta);
  switch (kernel.kind) {
    case RobustKernelKind::kHuber:  // beyond delta: relative = 2 u / delta - 1
      return relative <= 1.0 ? 1.0 : 2.0 / (relative + 1.0);
    case RobustKernelKind::kGemanMcClure:  // relative = 1 - g
      return (1.0 - relative) * (1.0 - relative);
    case RobustKernelKind::kNone:
      break;
  }
  return 1.0;
}

}  // namespace unisim
