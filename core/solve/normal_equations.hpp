// SPDX-License-Identifier: MIT
// Linearised cost of a graph: H = sum J' w J and g = sum J' w e.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/graph/graph.hpp"
#include "core/solve/assembly.hpp"
#include "core/solve/block.hpp"
#include "core/solve/block_pattern.hpp"

namespace unisim {

class QuadCollector;

/// Puts H (IRLS weights included) and g together from the edges of a graph.
class NormalEquations {
 public:
  NormalEquations() = default;
  NormalEquations(Arena& arena, const SolverCapacity& capacity);

  /// Linearise at the present poses the active edges that touch a wanted column, and add them to
  /// its blocks, which are zero before. g and the cost of other edges stay as they were.
  /// @return cost of the graph, sum of rho(u); edges between two fixed nodes count too
  double linearize(const Graph& graph, const BlockPattern& pattern, const Assembly& target);

  /// The structure has changed: `columns`, former numbers ascending, come first now.
  void keep(Span<const int32_t> columns);

  /// g, one vector per column.
  Span<const BlockVector> gradient() const { return {gradient_.data(), columns_}; }

 private:
  void clear_wanted();
  void add_pose_edge(const Graph& graph, int32_t id, QuadCollector* quads);
  double add_scale_edge(const Graph& graph, int32_t id);
  struct Ends;
  Ends ends_of(const Graph& graph, int32_t id) const;

  const BlockPattern* pattern_ = nullptr;  // of the present call
  Assembly target_ = {};
  int32_t columns_ = 0;
  Span<BlockVector> gradient_;
  Span<Block> sink_;
  Span<double> edge_cost_;
};

}  // namespace unisim
