// SPDX-License-Identifier: MIT
// Linearised cost of a graph.
#include "core/solve/normal_equations.hpp"

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

/// Columns and blocks an edge adds to; -1 or nullptr: none there.
struct NormalEquations::Ends {
  int32_t a;
  int32_t b;
  Block* diagonal_a;
  Block* diagonal_b;
  Block* coupling;
  bool a_is_later;
};

NormalEquations::NormalEquations(Arena& arena, const SolverCapacity& capacity)
    : gradient_(arena.take<BlockVector>(capacity.nodes)),
      edge_cost_(arena.take<double>(capacity.edges)) {}

NormalEquations::Ends NormalEquations::ends_of(const Graph& graph, int32_t id) const {
  const Edge& edge = graph.edge(id);
  const auto wanted = [&](int32_t node) {
    const int32_t column = pattern_->column_of_node(node);
    return column >= 0 && target_.wants(column) ? column : -1;
  };
  const auto diagonal = [&](int32_t column) {
    return column < 0 ? nullptr : target_.blocks + target_.diagonal[column];
  };
  Ends ends = {wanted(edge.a), wanted(edge.b), nullptr, nullptr, nullptr, false};
  ends.diagonal_a = diagonal(ends.a);
  ends.diagonal_b = diagonal(ends.b);
  const EdgeSlot place = pattern_->edge_slot(id);
  ends.a_is_later = place.a_is_later;
  if (place.slot >= 0 && (place.a_is_later ? ends.b : ends.a) >= 0) {
    ends.coupling = target_.blocks + target_.off_diagonal[place.slot];
  }
  return ends;
}

void NormalEquations::keep(Span<const int32_t> columns) {
  for (int32_t i = 0; i < columns.size(); ++i) gradient_[i] = gradient_[columns[i]];
}

double NormalEquations::linearize(const Graph& graph, const BlockPattern& pattern,
                                  const Assembly& target) {
  pattern_ = &pattern;
  target_ = target;
  columns_ = pattern.columns();
  for (int32_t column = 0; column < columns_; ++column) {
    if (target.wants(column)) gradient_[column] = BlockVector{};
  }
  double cost = 0.0;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (!edge.active()) {
      edge_cost_[id] = 0.0;
      continue;
    }
    const int32_t a = pattern.column_of_node(edge.a);
    const int32_t b = pattern.column_of_node(edge.b);
    const bool between_fixed = a < 0 && b < 0;
    if (between_fixed || (a >= 0 && target.wants(a)) || (b >= 0 && target.wants(b))) {
      edge_cost_[id] = add_edge(graph, id);
    }
    cost += edge_cost_[id];
  }
  return cost;
}

double NormalEquations::add_edge(const Graph& graph, int32_t id) {
  const FactorKind kind = graph.edge(id).kind;
  if (kind == FactorKind::kChain) return add_chain_edge(graph, id);
  return is_pose_factor(kind) ? add_pose_edge(graph, id) : add_scale_edge(graph, id);
}

double NormalEquations::add_pose_edge(const Graph& graph, int32_t id) {
  const Edge& edge = graph.edge(id);
  RelativePoseNormal normal;
  relative_pose_normal(graph.pose(edge.a), graph.pose(edge.b), graph.measurement(edge.P),
                       edge.Q < 0 ? nullptr : &graph.measurement(edge.Q), &normal);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * normal.e.squaredNorm());
  const double w = edge.weight() * robust.weight;
  const Ends ends = ends_of(graph, id);
  if (ends.a >= 0) {
    add_symmetric(*ends.diagonal_a, w, normal.H_aa);
    add_vector(gradient_[ends.a], w, normal.g_a);
  }
  if (ends.b >= 0) {
    add_symmetric(*ends.diagonal_b, w, normal.H_bb);
    add_vector(gradient_[ends.b], w, normal.g_b);
  }
  if (ends.coupling != nullptr) add_coupling(*ends.coupling, w, normal.H_ba, ends.a_is_later);
  return robust.cost;
}

double NormalEquations::add_chain_edge(const Graph& graph, int32_t id) {
  const Edge& edge = graph.edge(id);
  ChainNormal normal;
  chain_normal(graph.pose(edge.a), graph.pose(edge.b), graph.link(edge), &normal);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * normal.u_squared);
  const double w = edge.weight() * robust.weight;
  const Ends ends = ends_of(graph, id);
  if (ends.a >= 0) {
    add_lower(*ends.diagonal_a, w, normal.H_aa);
    add_vector(gradient_[ends.a], w, normal.g_a);
  }
  if (ends.b >= 0) {
    add_lower(*ends.diagonal_b, w, normal.H_bb);
    add_vector(gradient_[ends.b], w, normal.g_b);
  }
  if (ends.coupling != nullptr) add_coupling(*ends.coupling, w, normal.H_ba, ends.a_is_later);
  return robust.cost;
}

double NormalEquations::add_scale_edge(const Graph& graph, int32_t id) {
  const Edge& edge = graph.edge(id);
  const double e = scale_ratio_residual(graph.pose(edge.a), graph.pose(edge.b), edge.log_ratio);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * e * e);
  const double w = edge.weight() * robust.weight;
  const Ends ends = ends_of(graph, id);
  if (ends.a >= 0) {
    ends.diagonal_a->at(kLogScale, kLogScale) += w;
    gradient_[ends.a].v[kLogScale] -= w * e;
  }
  if (ends.b >= 0) {
    ends.diagonal_b->at(kLogScale, kLogScale) += w;
    gradient_[ends.b].v[kLogScale] += w * e;
  }
  if (ends.coupling != nullptr) ends.coupling->at(kLogScale, kLogScale) -= w;
  return robust.cost;
}

}  // namespace unisim
