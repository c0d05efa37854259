// SPDX-License-Identifier: MIT
// Turns a small graph into one chain edge between two of its nodes.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/graph/chain.hpp"
#include "core/graph/graph.hpp"
#include "core/solve/lm.hpp"

namespace unisim {

/// Eliminates all nodes of a small graph but two.
///
/// clear(), build graph() with poses relative to the first of the two, then condense(). The
/// measurement is the optimum of the small graph and Lambda the Schur complement on the second node
/// with the first one held: both are relative, so the edge stays right wherever the map moves.
class Condenser {
 public:
  Condenser() = default;
  Condenser(Arena& arena, const GraphCapacity& capacity);

  void clear() { graph_.clear(); }
  Graph& graph() { return graph_; }

  /// @param a, b nodes of graph(); poses of graph() are optimised on the way
  /// @return false when pose factors do not join a and b, or do not determine b
  bool condense(int32_t a, int32_t b, ChainLink* link);

 private:
  void hold_unreached(int32_t a);

  Graph graph_;
  LevenbergMarquardt solver_;
  Span<uint8_t> reached_;
};

}  // namespace unisim
