// SPDX-License-Identifier: MIT
// Which keyframe goes when the map is full.
#pragma once

#include <cstdint>

#include "drivers/geometric/map/landmark_map.hpp"

namespace unisim::geometric {

/// The keyframe that the others can best do without. The newer half always stays: tracks, windows
/// and their revisions live there. Of the older half goes
/// 1. the oldest without a pose;
/// 2. else the one whose landmarks most others see too, by the mean over its landmarks of
///    1 / (views - 1): what each would lose with this view;
/// 3. the oldest, where landmarks have hardly a view to spare any more: a long path without return
///    is forgotten from its beginning.
int32_t least_needed_keyframe(const LandmarkMap& map);

}  // namespace unisim::geometric
