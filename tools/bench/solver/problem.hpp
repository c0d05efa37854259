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
  /// All of the graph.
  /// @throws replay::Failure when the core refuses the graph
  Problem(const PoseGraph& source, int32_t factor_blocks);
  /// Room for the graph, but none of it yet.
  static Problem empty(const PoseGraph& source, int32_t factor_blocks) {
    return Problem(source, factor_blocks, Empty());
  }
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  /// @throws replay::Failure when the core refuses it
  void add_node(const FileNode& node);
  void add_edge(const PoseGraph& source, const FileEdge& edge);

  Graph& graph() { return graph_; }
  LevenbergMarquardt& solver() { return solver_; }
  size_t arena_bytes() const { return memory_.size(); }

 private:
  struct Empty {};
  Problem(const PoseGraph& source, int32_t factor_blocks, Empty);

  std::vector<unsigned char> memory_;
  Graph graph_;
  LevenbergMarquardt solver_;
};

}  // namespace unisim::bench
