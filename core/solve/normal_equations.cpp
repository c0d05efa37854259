// SPDX-License-Identifier: MIT
// Linearised cost of a graph.
#include "core/solve/normal_equations.hpp"

#include <cstring>
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

// One block more than the structure has: what an edge would add to a fixed node goes there.
NormalEquations::NormalEquations(Arena& arena, const SolverCapacity& capacity)
    : diagonal_(arena.take<Block>(capacity.nodes + 1)),
      off_diagonal_(arena.take<Block>(capacity.pairs + 1)),
      gradient_(arena.take<BlockVector>(capacity.nodes + 1)) {}

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
  QuadCollector quads;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (!edge.active()) continue;
    if (is_pose_factor(edge.kind)) {
      add_pose_edge(graph, pattern, id, &quads);
    } else {
      cost += add_scale_edge(graph, pattern, id);
    }
  }
  return cost + quads.finish();
}

void NormalEquations::add_pose_edge(const Graph& graph, const BlockPattern& pattern, int32_t id,
                                    QuadCollector* quads) {
  const Edge& edge = graph.edge(id);
  const int32_t a = pattern.column_of_node(edge.a);
  const int32_t b = pattern.column_of_node(edge.b);
  const EdgeSlot place = pattern.edge_slot(id);
  const int32_t no_column = diagonal_.size() - 1;
  const int32_t no_slot = off_diagonal_.size() - 1;
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
  out.H_aa = &diagonal_[a >= 0 ? a : no_column];
  out.H_bb = &diagonal_[b >= 0 ? b : no_column];
  out.g_a = gradient_[a >= 0 ? a : no_column].v;
  out.g_b = gradient_[b >= 0 ? b : no_column].v;
  out.H_ab = &off_diagonal_[place.slot >= 0 ? place.slot : no_slot];
  quads->add(shape_of(edge), place.a_is_later, out);
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
