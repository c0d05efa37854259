// SPDX-License-Identifier: MIT
// A loop whose keyframes have retired: one chain edge of the graph.
#pragma once

#include <cstdint>

#include "core/map/submap_table.hpp"

namespace unisim {

/// Loops between the same two nodes that agree share one.
struct LoopEdge {
  int32_t edge = -1;  ///< in the graph, -1: free place
  int32_t loop = -1;  ///< newest loop submap in it, for messages
  int32_t loops = 0;  ///< in it
  LoopHealth health;
};

}  // namespace unisim
