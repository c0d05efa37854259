// SPDX-License-Identifier: MIT
// Linearised cost of a graph: H = sum J' w J and g = sum J' w e.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/graph/graph.hpp"
#include "core/solve/factor/block.hpp"
#include "core/solve/linearize/assembly.hpp"
#include "core/solve/linearize/linearization_points.hpp"
#include "core/solve/order/block_pattern.hpp"

namespace unisim {

class QuadCollector;

constexpr int kLogScale = 6;  ///< where a tangent (core/lie/sim3.hpp) holds the log-scale

/// Puts H (IRLS weights included) and g together from the edges of a graph.
class NormalEquations {
 public:
  NormalEquations() = default;
  NormalEquations(Arena& arena, const SolverCapacity& capacity);

  /// Add the active edges that touch a wanted column to its blocks of H, which are zero before, and
  /// bring g up to date in columns that have changed. g is that of the present poses; an edge adds
  /// to H what it did in the columns of its other end, or is linearised anew where both are wanted.
  /// @param remember keep the poses of the linearisation, for point_holds()
  /// @return cost of the graph, sum of rho(u); edges between two fixed nodes count too
  double linearize(const Graph& graph, const BlockPattern& pattern, const Assembly& target,
                   bool remember);

  /// An end of the edge has moved. @return whether its part of H may stay as it is
  /// @param tolerance see LmOptions::relinearize
  bool point_holds(const Graph& graph, int32_t edge, double tolerance) {
    return points_.follows(graph, edge, edge_cost_[edge], tolerance);
  }
  void forget_point(int32_t edge) { points_.forget(edge); }
  void forget_points() { points_.forget_all(); }

  /// g has changed in this column.
  void mark_changed(int32_t column) { changed_[column] = 1; }
  void mark_all_changed() { changed_.fill(1); }
  bool has_changed(int32_t column) const { return changed_[column] != 0; }

  /// The structure has changed: `columns`, former numbers ascending, come first now; the others
  /// count as changed.
  void keep(Span<const int32_t> columns);

  /// g, one vector per column.
  Span<const BlockVector> gradient() const { return {gradient_.data(), columns_}; }

 private:
  struct Ends;
  Ends ends_of(const Graph& graph, int32_t id) const;
  /// A vector that nobody reads.
  BlockVector* no_gradient() const { return gradient_.end() - 1; }
  void clear_changed();
  void add_pose_edge(const Graph& graph, int32_t id, const Ends& ends, QuadCollector* quads);
  void add_scale_edge(const Graph& graph, int32_t id, const Ends& ends);
  double finish_costs(const Graph& graph, bool remember);

  const BlockPattern* pattern_ = nullptr;  // of the present call
  Assembly target_ = {};
  int32_t columns_ = 0;
  Span<BlockVector> gradient_;
  Span<uint8_t> changed_;
  LinearizationPoints points_;
  Span<Block> sink_;
  Span<double> edge_cost_;
};

}  // namespace unisim
