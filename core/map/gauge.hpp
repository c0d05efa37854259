// SPDX-License-Identifier: MIT
// Takes the freedom of position, orientation and scale out of a graph.
#pragma once

#include <cstdint>

#include "core/graph/graph.hpp"

namespace unisim {

/// Holds one node of every part of a graph that pose factors connect: its first skeleton
/// node, else its first keyframe, else its first submap. Scale factors alone do not connect: they
/// leave six dimensions open. A metre is measured against the map and never held.
class Gauge {
 public:
  Gauge() = default;
  Gauge(Arena& arena, int32_t nodes) : parent_(arena.take<int32_t>(nodes)) {}

  /// Fix and release nodes as needed; nothing to do while the same edges are active as at the last
  /// call.
  Status apply(Graph* graph);

 private:
  int32_t root_of(int32_t node);
  static bool comes_first(const Graph& graph, int32_t a, int32_t b);

  Span<int32_t> parent_;  // union-find; the root is the node to hold
  uint64_t activity_revision_ = 0;
};

}  // namespace unisim
