// SPDX-License-Identifier: MIT
// Whether a pose that comes out is one.
#pragma once

#include <cmath>

#include "unisim/unisim.h"

namespace unisim::test {

inline bool is_pose(const unisim_sim3& T) {
  double norm = 0.0;
  for (const double value : T.q) norm += value * value;
  bool finite = std::isfinite(T.s) && T.s > 0.0;
  for (const double value : T.t) finite = finite && std::isfinite(value);
  return finite && std::abs(norm - 1.0) < 1e-6;
}

}  // namespace unisim::test
