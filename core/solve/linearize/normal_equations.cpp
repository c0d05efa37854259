// SPDX-License-Identifier: MIT
// Linearised cost of a graph.
#include "core/solve/linearize/normal_equations.hpp"

#include <limits>

#include "core/graph/scale_ratio.hpp"
#include "core/solve/linearize/quad_collector.hpp"

namespace unisim {
namespace {

QuadShape shape_of(const Edge& edge) {
  if (edge.kind == FactorKind::kChain) return QuadShape::kChain;
  if (edge.kind == FactorKind::kRigid) return QuadShape::kRigid;
  return edge.Q < 0 ? QuadShape::kOneMeasurement : QuadShape::kTwoMeasurements;
}

// The identity as such.
constexpr double kOrigin[8] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

// A Sim3 as eight numbers in a row.
const double* numbers(const Sim3& T) { return T.q.coeffs().data(); }

}  // namespace

/// Where the numbers of one edge between nodes a and b are added: up to three blocks of H and two
/// of the gradient.
///
/// Not all are wanted each time, since only stale columns are linearised anew and a fixed node has
/// no column. The pointer of one that is not wanted leads to a sink, memory that nobody reads, so
/// that the sums need no case by case.
struct NormalEquations::Ends {
  bool needs_blocks;
  bool needs_gradient;
  bool is_whole;    ///< no column holds an older part of the edge
  bool a_is_later;  ///< a has the later column: the coupling block is its row
  Block* diagonal_a;
  Block* diagonal_b;
  Block* coupling;
  BlockVector* gradient_a;
  BlockVector* gradient_b;
};

// The last elements of gradient and costs and the block are sinks: what is put there nobody reads.
NormalEquations::NormalEquations(Arena& arena, const SolverCapacity& capacity)
    : gradient_(arena.take<BlockVector>(capacity.nodes + 1)),
      changed_(arena.take<uint8_t>(capacity.nodes)),
      points_(arena, capacity.edges),
      sink_(arena.take<Block>(1)),
      edge_cost_(arena.take<double>(capacity.edges + 1)) {}

NormalEquations::Ends NormalEquations::ends_of(const Graph& graph, int32_t id) const {
  const Edge& edge = graph.edge(id);
  const EdgeSlot place = pattern_->edge_slot(id);
  const int32_t a = pattern_->column_of_node(edge.a);
  const int32_t b = pattern_->column_of_node(edge.b);
  const bool wants_a = a >= 0 && target_.wants(a);
  const bool wants_b = b >= 0 && target_.wants(b);
  const bool changed_a = a >= 0 && has_changed(a);
  const bool changed_b = b >= 0 && has_changed(b);
  Ends ends;
  ends.needs_blocks = wants_a || wants_b;
  ends.needs_gradient = changed_a || changed_b || (a < 0 && b < 0);
  ends.is_whole = (a < 0 || wants_a) && (b < 0 || wants_b);
  ends.a_is_later = place.a_is_later;
  if (wants_a) target_.open(a);
  if (wants_b) target_.open(b);
  Block* const sink = sink_.data();
  const bool has_place = place.slot >= 0 && (place.a_is_later ? wants_b : wants_a);
  ends.diagonal_a = wants_a ? target_.blocks + target_.diagonal[a] : sink;
  ends.diagonal_b = wants_b ? target_.blocks + target_.diagonal[b] : sink;
  ends.coupling = has_place ? target_.blocks + target_.off_diagonal[place.slot] : sink;
  ends.gradient_a = changed_a ? &gradient_[a] : no_gradient();
  ends.gradient_b = changed_b ? &gradient_[b] : no_gradient();
  return ends;
}

void NormalEquations::keep(Span<const int32_t> columns) {
  for (int32_t i = 0; i < columns.size(); ++i) {
    gradient_[i] = gradient_[columns[i]];
    changed_[i] = changed_[columns[i]];
  }
  for (int32_t i = columns.size(); i < changed_.size(); ++i) changed_[i] = 1;
}

void NormalEquations::clear_changed() {
  for (int32_t column = 0; column < columns_; ++column) {
    if (has_changed(column)) gradient_[column] = BlockVector{};
  }
  *no_gradient() = BlockVector{};
  sink_[0] = Block{};
}

double NormalEquations::linearize(const Graph& graph, const BlockPattern& pattern,
                                  const Assembly& target, bool remember) {
  pattern_ = &pattern;
  target_ = target;
  columns_ = pattern.columns();
  clear_changed();
  QuadCollector quads;
  for (const int32_t id : pattern.edges()) {
    const Edge& edge = graph.edge(id);
    if (!edge.active()) {
      edge_cost_[id] = 0.0;
      continue;
    }
    // Between two fixed nodes only the cost is wanted.
    const bool fixed = pattern.column_of_node(edge.a) < 0 && pattern.column_of_node(edge.b) < 0;
    if (fixed && points_.cost_holds(id)) continue;
    const Ends ends = ends_of(graph, id);
    if (!ends.needs_blocks && !ends.needs_gradient) continue;
    const bool moves_here = ends.is_whole && !points_.is_here(id);
    if (remember && (moves_here || !points_.knows(id))) points_.set(graph, id);
    if (is_pose_factor(edge.kind)) {
      add_pose_edge(graph, id, ends, &quads);
    } else {
      add_scale_edge(graph, id, ends);
    }
  }
  quads.finish();
  changed_.fill(0);
  return finish_costs(graph, remember);
}

double NormalEquations::finish_costs(const Graph& graph, bool remember) {
  double cost = 0.0;
  for (const int32_t id : pattern_->edges()) {
    cost += edge_cost_[id];
    if (remember && points_.needs_cost(id)) points_.set_cost(graph, id, edge_cost_[id]);
  }
  return cost;
}

void NormalEquations::add_pose_edge(const Graph& graph, int32_t id, const Ends& ends,
                                    QuadCollector* quads) {
  const Edge& edge = graph.edge(id);
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
  const bool is_here = points_.is_here(id);
  const bool both_at_once = ends.needs_blocks && is_here;
  if (ends.needs_gradient && !both_at_once) quads->add_gradient(shape_of(edge), out);
  if (!ends.needs_blocks) return;
  if (!is_here) {
    out.A = kOrigin;
    out.B = numbers(points_.relative_pose(id));
    out.g_a = out.g_b = no_gradient()->v;
    out.cost = edge_cost_.end() - 1;
  }
  quads->add(shape_of(edge), ends.a_is_later, out);
}

void NormalEquations::add_scale_edge(const Graph& graph, int32_t id, const Ends& ends) {
  const Edge& edge = graph.edge(id);
  const double e = scale_ratio_residual(graph.pose(edge.a), graph.pose(edge.b), edge.log_ratio);
  const RobustCost robust = robust_cost(edge.kernel, edge.weight() * e * e);
  edge_cost_[id] = robust.cost;
  const double slope = edge.weight() * robust.weight * e;
  ends.gradient_a->v[kLogScale] -= slope;
  ends.gradient_b->v[kLogScale] += slope;
  const double w =
      edge.weight() * (points_.is_here(id) ? robust.weight : points_.robust_weight(id));
  ends.diagonal_a->at(kLogScale, kLogScale) += w;
  ends.diagonal_b->at(kLogScale, kLogScale) += w;
  ends.coupling->at(kLogScale, kLogScale) -= w;
  if (edge.kind != FactorKind::kMetric) return;
  // Nothing depends on the rest of a metre's pose: it stays.
  for (int d = 0; d < kLogScale; ++d) ends.diagonal_a->at(d, d) += w;
}

}  // namespace unisim
