// SPDX-License-Identifier: MIT
// Robust kernels per lane, for vectorised sources: robust_kernel.hpp, all kernels at once.
#pragma once

#include "core/base/pack.hpp"

namespace unisim {
namespace UNISIM_ISA {

/// Kernel and weight w of an edge: its cost is rho(u), u^2 = w e' e.
struct PackKernel {
  Pack weight;
  Pack delta;          ///< width, infinite: none
  Pack geman_mcclure;  ///< 1: that kernel, 0: Huber
};

struct PackRobustCost {
  Pack cost;
  Pack weight;
};

UNISIM_ALWAYS_INLINE PackRobustCost robust_cost(const PackKernel& kernel, Pack u_squared) {
  const PackMask is_geman_mcclure = splat(0.0) < kernel.geman_mcclure;
  const Pack delta2 = kernel.delta * kernel.delta;
  const Pack half = 0.5 * u_squared;
  const Pack u = square_root(u_squared);
  const PackMask inside = u_squared <= delta2;
  const Pack g = 1.0 / (1.0 + u_squared / delta2);
  const Pack huber_cost = select(inside, half, kernel.delta * (u - 0.5 * kernel.delta));
  const Pack huber_weight = select(inside, splat(1.0), kernel.delta / u);
  return {select(is_geman_mcclure, half * g, huber_cost),
          select(is_geman_mcclure, g * g, huber_weight)};
}

}  // namespace UNISIM_ISA
}  // namespace unisim
