// SPDX-License-Identifier: MIT
// Makes two segments of the map one.
#pragma once

#include "drivers/geometric/bundle/world_move.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

/// Moves the keyframes and landmarks of segment `from` into segment `into`, which the state goes on
/// in. One of the two is the present segment.
/// @param move from the one's world to the other's
void join_segments(State* state, int32_t from, int32_t into, const WorldMove& move);

}  // namespace unisim::geometric
