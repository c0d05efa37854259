// SPDX-License-Identifier: MIT
// Turns a small graph into one chain edge between two of its nodes.
#include "core/solve/factor/condenser.hpp"

#include <algorithm>

#include "core/base/positive_definite.hpp"

namespace unisim {
namespace {

constexpr int32_t kIterations = 10;

SolverCapacity solver_capacity(const GraphCapacity& capacity) {
  SolverCapacity solver;
  solver.nodes = capacity.nodes;
  solver.edges = capacity.edges;
  const int32_t all_pairs = capacity.nodes * (capacity.nodes - 1) / 2;
  solver.pairs = std::min(capacity.edges, all_pairs);
  solver.factor_blocks = static_cast<int32_t>(dense_factor_blocks(capacity.nodes));
  return solver;
}

}  // namespace

Condenser::Condenser(Arena& arena, const GraphCapacity& capacity)
    : graph_(arena, capacity),
      solver_(arena, solver_capacity(capacity)),
      reached_(arena.take<uint8_t>(capacity.nodes)) {}

/// Nodes that no pose factors join to a say nothing about b, but would leave the system singular.
void Condenser::hold_unreached(int32_t a) {
  for (uint8_t& reached : reached_) reached = 0;
  reached_[a] = 1;
  for (bool grew = true; grew;) {
    grew = false;
    for (int32_t id = 0; id < graph_.edge_end(); ++id) {
      const Edge& edge = graph_.edge(id);
      if (!edge.active() || !is_pose_factor(edge.kind)) continue;
      if (reached_[edge.a] == reached_[edge.b]) continue;
      reached_[edge.a] = 1;
      reached_[edge.b] = 1;
      grew = true;
    }
  }
  for (int32_t node = 0; node < graph_.node_end(); ++node) {
    if (!graph_.has_node(node)) continue;
    const Status status = graph_.set_fixed(node, node == a || reached_[node] == 0);
    UNISIM_CHECK(is_ok(status));
    static_cast<void>(status);
  }
}

bool Condenser::condense(int32_t a, int32_t b, ChainLink* link) {
  hold_unreached(a);
  if (reached_[b] == 0) return false;
  LmOptions options;
  options.max_iterations = kIterations;
  LmReport report;
  solver_.forget();
  if (!is_ok(solver_.optimize(&graph_, options, &report))) return false;
  Mat7 covariance;
  if (!is_ok(solver_.marginal_covariance(graph_, b, &covariance))) return false;
  link->Z_a_b = between(graph_.pose(a), graph_.pose(b));
  link->Lambda = inverse_of_positive(0.5 * (covariance + covariance.transpose()));
  return valid_link(*link);
}

}  // namespace unisim
