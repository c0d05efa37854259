// SPDX-License-Identifier: MIT
// Linearised cost of a graph.
#include "core/solve/normal_equations.hpp"

#include <cstring>

#include "core/graph/chain.hpp"
#include "core/graph/relative_pose.hpp"
#include "core/graph/scale_ratio.hpp"

namespace unisim {
namespace {

constexpr int kLogScale = 6;

// Lower triangle += w S.
void add_symmetric(Block& block, double w, const SymmetricBlocks& S) {
  for (int c = 0; c < 3; ++c) {
    for (int r = c; r < 3; ++r) {
      block.at(r, c) += w * S.tt(r, c);
      block.at(r + 3, c + 3) += w * S.rr(r, c);
    }
    for (int r = 0; r < 3; ++r) block.at(r + 3, c) += w * S.tr(c, r);
    block.at(6, c) += w * S.ts(c);
    block.at(6, c + 3) += w * S.rs(c);
  }
  block.at(6, 6) += w * S.ss;
}

// Lower triangle += w M.
void add_lower(Block& block, double w, const Mat7& M) {
  for (int c = 0; c < kTangentDim; ++c) {
    for (int r = c; r < kTangentDim; ++r) block.at(r, c) += w * M(r, c);
  }
}

// Block += w H_ba, transposed when its rows are those of a.
void add_coupling(Block& block, double w, const Mat7& H_ba, bool a_is_later) {
  for (int c = 0; c < kTangentDim; ++c) {
    for (int r = 0; r < kTangentDim; ++r) {
      block.at(r, c) += w * (a_is_later ? H_ba(c, r) : H_ba(r, c));
    }
  }
}

void add_vector(BlockVector& target, double w, const Vec7& g) {
  for (int r = 0; r < kTangentDim; ++r) target.v[r] += w * g(r);
}

}  // namespace

NormalEquations::NormalEquations(Arena& arena, const SolverCapacity& capacity)
    : diagonal_(arena.take<Block>(capacity.nodes)),
      off_diagonal_(arena.take<Block>(capacity.pairs)),
      gradient_(arena.take<BlockVector>(capacity.nodes)) {}

void NormalEquations::clear(const BlockPattern& pattern) {
  columns_ = pattern.columns();
  const size_t columns = static_cast<size_t>(columns_);
  const size_t pairs = static_cast<size_t>(pattern.pairs());
  std::memset(static_cast<void*>(diagonal_.data()), 0, columns * sizeof(Block));
  std::memset(static_cast<void*>(off_diagonal_.data()), 0, pairs * sizeof(Block));
  std::memset(static_cast<void*>(gradient_.data()), 0, columns * sizeof(BlockVector));
}

double NormalEquations::linearize(const Graph& graph, const BlockPattern& pattern) {
  clear(pattern);
  double cost = 0.0;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (!edge.active()) continue;
    cost += add_edge(graph, pattern, id);
  }
  return cost;
}

double NormalEquations::add_edge(const Graph& graph, const BlockPattern& pattern, int32_t id) {
  const FactorKind kind = graph.edge(id).kind;
  if (kind == FactorKind::kChain) return add_chain_edge(graph, pattern, id);
  return is_pose_factor(kind) ? add_pose_edge(graph, pattern, id)
                              : add_scale_edge(graph, pattern, id);
}

double NormalEquations::add_pose_edge(const Graph& graph, const BlockPattern& pattern, int32_t id) {
  const Edge& edge = graph.edge(id);
  RelativePoseNormal normal;
  relative_pose_normal(graph.pose(edge.a), graph.pose(edge.b), graph.measurement(edge.P),
                       edge.Q < 0 ? nullptr : &graph.measurement(edge.Q), &normal);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * normal.e.squaredNorm());
  const double w = edge.weight() * robust.weight;
  const int32_t a = pattern.column_of_node(edge.a);
  const int32_t b = pattern.column_of_node(edge.b);
  if (a >= 0) {
    add_symmetric(diagonal_[a], w, normal.H_aa);
    add_vector(gradient_[a], w, normal.g_a);
  }
  if (b >= 0) {
    add_symmetric(diagonal_[b], w, normal.H_bb);
    add_vector(gradient_[b], w, normal.g_b);
  }
  const EdgeSlot place = pattern.edge_slot(id);
  if (place.slot < 0) return robust.cost;
  add_coupling(off_diagonal_[place.slot], w, normal.H_ba, place.a_is_later);
  return robust.cost;
}

double NormalEquations::add_chain_edge(const Graph& graph, const BlockPattern& pattern,
                                       int32_t id) {
  const Edge& edge = graph.edge(id);
  ChainNormal normal;
  chain_normal(graph.pose(edge.a), graph.pose(edge.b), graph.link(edge), &normal);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * normal.u_squared);
  const double w = edge.weight() * robust.weight;
  const int32_t a = pattern.column_of_node(edge.a);
  const int32_t b = pattern.column_of_node(edge.b);
  if (a >= 0) {
    add_lower(diagonal_[a], w, normal.H_aa);
    add_vector(gradient_[a], w, normal.g_a);
  }
  if (b >= 0) {
    add_lower(diagonal_[b], w, normal.H_bb);
    add_vector(gradient_[b], w, normal.g_b);
  }
  const EdgeSlot place = pattern.edge_slot(id);
  if (place.slot >= 0) {
    add_coupling(off_diagonal_[place.slot], w, normal.H_ba, place.a_is_later);
  }
  return robust.cost;
}

double NormalEquations::add_scale_edge(const Graph& graph, const BlockPattern& pattern,
                                       int32_t id) {
  const Edge& edge = graph.edge(id);
  const double e = scale_ratio_residual(graph.pose(edge.a), graph.pose(edge.b), edge.log_ratio);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * e * e);
  const double w = edge.weight() * robust.weight;
  const int32_t a = pattern.column_of_node(edge.a);
  const int32_t b = pattern.column_of_node(edge.b);
  if (a >= 0) {
    diagonal_[a].at(kLogScale, kLogScale) += w;
    gradient_[a].v[kLogScale] -= w * e;
  }
  if (b >= 0) {
    diagonal_[b].at(kLogScale, kLogScale) += w;
    gradient_[b].v[kLogScale] += w * e;
  }
  const EdgeSlot place = pattern.edge_slot(id);
  if (place.slot >= 0) off_diagonal_[place.slot].at(kLogScale, kLogScale) -= w;
  return robust.cost;
}

BlockMatrixView NormalEquations::H(const BlockPattern& pattern) const {
  return {pattern.column_start(),
          pattern.rows(),
          {diagonal_.data(), pattern.columns()},
          {off_diagonal_.data(), pattern.pairs()}};
}

}  // namespace unisim
