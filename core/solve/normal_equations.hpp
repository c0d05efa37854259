// SPDX-License-Identifier: MIT
// Linearised cost of a graph: H = sum J' w J and g = sum J' w e.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/graph/graph.hpp"
#include "core/solve/block.hpp"
#include "core/solve/block_cholesky.hpp"
#include "core/solve/block_pattern.hpp"

namespace unisim {

class QuadCollector;

/// Values of H (IRLS weights included) and g on a BlockPattern.
class NormalEquations {
 public:
  NormalEquations() = default;
  NormalEquations(Arena& arena, const SolverCapacity& capacity);

  /// Linearise all active edges at the present poses.
  /// @return cost of the graph, sum of rho(u); edges between two fixed nodes count too
  double linearize(const Graph& graph, const BlockPattern& pattern);

  /// H of the last linearize().
  BlockMatrixView H(const BlockPattern& pattern) const;
  /// g of the last linearize(), one vector per column.
  Span<const BlockVector> gradient() const { return {gradient_.data(), columns_}; }

 private:
  void add_pose_edge(const Graph& graph, const BlockPattern& pattern, int32_t id,
                     QuadCollector* quads);
  double add_scale_edge(const Graph& graph, const BlockPattern& pattern, int32_t id);
  void clear(const BlockPattern& pattern);

  int32_t columns_ = 0;
  Span<Block> diagonal_;
  Span<Block> off_diagonal_;
  Span<BlockVector> gradient_;
};

}  // namespace unisim
