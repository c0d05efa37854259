// SPDX-License-Identifier: MIT
// Linearised cost of a graph.
#include "core/solve/normal_equations.hpp"

#include <limits>

#include "core/graph/scale_ratio.hpp"
#include "core/solve/quad_collector.hpp"

namespace unisim {
namespace {

constexpr int kLogScale = 6;

QuadShape shape_of(const Edge& edge) {
  if (edge.kind == FactorKind::kChain) return QuadShape::kChain;
  if (edge.kind == FactorKind::kRigid) return QuadShape::kRigid;
  return edge.Q < 0 ? QuadShape::kOneMeasurement : QuadShape::kTwoMeasurements;
}

// A Sim3 as eight numbers in a row.
const double* numbers(const Sim3& T) { return T.q.coeffs().data(); }

}  // namespace

/// Where an edge adds: the sinks for what is fixed or not wanted.
struct NormalEquations::Ends {
  Block* diagonal_a;
  Block* diagonal_b;
  Block* coupling;
  BlockVector* gradient_a;
  BlockVector* gradient_b;
  bool a_is_later;
};

// The last element of the gradient and the block are sinks: what is added there nobody reads.
NormalEquations::NormalEquations(Arena& arena, const SolverCapacity& capacity)
    : gradient_(arena.take<BlockVector>(capacity.nodes + 1)),
      sink_(arena.take<Block>(1)),
      edge_cost_(arena.take<double>(capacity.edges)) {}

NormalEquations::Ends NormalEquations::ends_of(const Graph& graph, int32_t id) const {
  const Edge& edge = graph.edge(id);
  const EdgeSlot place = pattern_->edge_slot(id);
  const int32_t a = pattern_->column_of_node(edge.a);
  const int32_t b = pattern_->column_of_node(edge.b);
  const bool wants_a = a >= 0 && target_.wants(a);
  const bool wants_b = b >= 0 && target_.wants(b);
  Block* const sink = sink_.data();
  BlockVector* const no_gradient = &gradient_[gradient_.size() - 1];
  Ends ends = {sink, sink, sink, no_gradient, no_gradient, place.a_is_later};
  if (wants_a) {
    ends.diagonal_a = target_.blocks + target_.diagonal[a];
    ends.gradient_a = &gradient_[a];
  }
  if (wants_b) {
    ends.diagonal_b = target_.blocks + target_.diagonal[b];
    ends.gradient_b = &gradient_[b];
  }
  if (place.slot >= 0 && (place.a_is_later ? wants_b : wants_a)) {
    ends.coupling = target_.blocks + target_.off_diagonal[place.slot];
  }
  return ends;
}

void NormalEquations::keep(Span<const int32_t> columns) {
  for (int32_t i = 0; i < columns.size(); ++i) gradient_[i] = gradient_[columns[i]];
}

void NormalEquations::clear_wanted() {
  for (int32_t column = 0; column < columns_; ++column) {
    if (target_.wants(column)) gradient_[column] = BlockVector{};
  }
  gradient_[gradient_.size() - 1] = BlockVector{};
  sink_[0] = Block{};
}

double NormalEquations::linearize(const Graph& graph, const BlockPattern& pattern,
                                  const Assembly& target) {
  pattern_ = &pattern;
  target_ = target;
  columns_ = pattern.columns();
  clear_wanted();
  QuadCollector quads;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (!edge.active()) {
      edge_cost_[id] = 0.0;
      continue;
    }
    const int32_t a = pattern.column_of_node(edge.a);
    const int32_t b = pattern.column_of_node(edge.b);
    const bool between_fixed = a < 0 && b < 0;
    const bool wanted = (a >= 0 && target.wants(a)) || (b >= 0 && target.wants(b));
    if (!between_fixed && !wanted) continue;
    if (is_pose_factor(edge.kind)) {
      add_pose_edge(graph, id, &quads);
    } else {
      edge_cost_[id] = add_scale_edge(graph, id);
    }
  }
  quads.finish();
  double cost = 0.0;
  for (int32_t id = 0; id < graph.edge_end(); ++id) cost += edge_cost_[id];
  return cost;
}

void NormalEquations::add_pose_edge(const Graph& graph, int32_t id, QuadCollector* quads) {
  const Edge& edge = graph.edge(id);
  const Ends ends = ends_of(graph, id);
  QuadEdge out;
  out.A = numbers(graph.pose(edge.a));
  out.B = numbers(graph.pose(edge.b));
  out.P = numbers(graph.measurement(edge.P));
  out.Q = edge.Q < 0 ? nullptr : numbers(graph.measurement(edge.Q));
  out.Lambda = edge.Lambda < 0 ? nullptr : graph.information(edge.Lambda).data();
  out.weight = edge.weight();
  out.delta = edge.kernel.kind == RobustKernelKind::kNone ? std::numeric_limits<double>::infinity()
                                                          : edge.kernel.delta;
  out.geman_mcclure = edge.kernel.kind == RobustKernelKind::kGemanMcClure;
  out.H_aa = ends.diagonal_a;
  out.H_bb = ends.diagonal_b;
  out.H_ab = ends.coupling;
  out.g_a = ends.gradient_a->v;
  out.g_b = ends.gradient_b->v;
  out.cost = &edge_cost_[id];
  quads->add(shape_of(edge), ends.a_is_later, out);
}

double NormalEquations::add_scale_edge(const Graph& graph, int32_t id) {
  const Edge& edge = graph.edge(id);
  const double e = scale_ratio_residual(graph.pose(edge.a), graph.pose(edge.b), edge.log_ratio);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * e * e);
  const double w = edge.weight() * robust.weight;
  const Ends ends = ends_of(graph, id);
  ends.diagonal_a->at(kLogScale, kLogScale) += w;
  ends.gradient_a->v[kLogScale] -= w * e;
  ends.diagonal_b->at(kLogScale, kLogScale) += w;
  ends.gradient_b->v[kLogScale] += w * e;
  ends.coupling->at(kLogScale, kLogScale) -= w;
  return robust.cost;
}

}  // namespace unisim
