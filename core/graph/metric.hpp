// SPDX-License-Identifier: MIT
// Metric factor between the metre of a segment and a submap whose unit is known in metres.
#pragma once

#include "core/base/math.hpp"
#include "core/graph/scale_ratio.hpp"

namespace unisim {

// The metre is a node of the graph whose scale says how long a metre is in the world's unit; its
// rotation and translation have no meaning. The residual as written, for tests: the solver runs
// scale_ratio.hpp for all scale factors.

/// e = log s_m - log s_M - log u, 1 row.
/// @param log_metres log of the metres u in one unit of submap m
inline double metric_residual(const Sim3& T_world_metre, const Sim3& T_world_submap,
                              double log_metres) {
  return scale_ratio_residual(T_world_metre, T_world_submap, log_metres);
}

/// What a known distance between two places says: log of the metres in a unit of the submap that
/// sees them at p and q.
/// @param metres > 0
inline double log_metres_per_unit(double metres, const Vec3& p, const Vec3& q) {
  return math::log(metres / (q - p).norm());
}

}  // namespace unisim
