// SPDX-License-Identifier: MIT
// A graph of a file as the solver of the core holds it, in memory of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "core/graph/graph.hpp"
#include "core/solve/lm.hpp"
#include "tools/bench/solver/pose_graph.hpp"

namespace unisim::bench {

/// Blocks the factor of a graph has, diagonal included: what a solver for it is declared with.
/// @throws replay::Failure when the core refuses the graph
int32_t needed_factor_blocks(const PoseGraph& source);

/// Graph and solver, sized for one pose graph. Nodes have the ids of PoseGraph::nodes.
class Problem {
 public:
  /// @throws replay::Failure when the core refuses the graph
  Problem(const PoseGraph& source, int32_t factor_blocks);
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  Graph& graph() { return graph_; }
  LevenbergMarquardt& solver() { return solver_; }
  size_t arena_bytes() const { return memory_.size(); }

 private:
  void fill(const PoseGraph& source);

  std::vector<unsigned char> memory_;
  Graph graph_;
  LevenbergMarquardt solver_;
};

}  // namespace unisim::bench
