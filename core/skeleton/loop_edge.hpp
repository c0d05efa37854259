// SPDX-License-Identifier: MIT
// A loop whose keyframes have retired: one chain edge of the graph.
#pragma once

#include <cstdint>

#include "core/map/submap_table.hpp"

namespace unisim {

/// Loops between the same two nodes that agree share one.
struct LoopEdge {
  int32_t edge = -1;  ///< in the graph, -1: free slot
  int32_t loop = -1;  ///< newest loop submap in it, for messages
  int32_t loops = 0;  ///< in it
  LoopHealth health;
  int32_t order_a = 0;  ///< position in time of its nodes, for the search of the weakest
  int32_t order_b = 0;
  uint64_t looked_at = 0;  ///< revision of the graph for which health.norm holds
};

}  // namespace unisim
