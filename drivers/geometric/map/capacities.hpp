// SPDX-License-Identifier: MIT
// How much the parts of the mapper hold: all of it made at the first image.
#pragma once

#include "drivers/geometric/bundle/bundle_problem.hpp"
#include "drivers/geometric/geometric.h"
#include "drivers/geometric/map/landmark_map.hpp"

namespace unisim::geometric {

/// Keyframes adjusted with each new one while the state is young, at most.
inline constexpr size_t kMaxEarlyWindow = 32;

int32_t observations_per_keyframe(const unisim_geometric_config& config);
MapCapacity map_capacity(const unisim_geometric_config& config);
/// Of the adjustment of the newest keyframes.
BundleCapacity window_capacity(const unisim_geometric_config& config);
/// Of the adjustment of all of them.
BundleCapacity whole_capacity(const unisim_geometric_config& config);

}  // namespace unisim::geometric
