// SPDX-License-Identifier: MIT
// Optimisation of the graph and what it changed.
#include <algorithm>
#include <cmath>

#include "core/session.hpp"

namespace unisim {
namespace {

// Smaller moves are the solver's tolerance on a converged map: keyframe's unit, rad, log-scale.
constexpr double kLeastMove = 1e-4;
// Poses that would move less stay where they are, and the solver leaves alone what only they see.
constexpr double kStillMove = 1e-6;
// Edges that change less keep their part of H: share of their length, rad, log-scale.
constexpr double kRelinearize = 1e-2;
// From so many degrees of freedom on, residuals say how sure the measurements are.
constexpr int32_t kTellingFreedom = 100;

void note_changed(int32_t first, int32_t last, OptimizeReport* report) {
  if (report->first_changed < 0 || first < report->first_changed) report->first_changed = first;
  report->last_changed = std::max(report->last_changed, last);
}

/// Rows of all active edges minus free unknowns; how long a metre is, is another matter.
int32_t degrees_of_freedom(const Graph& graph) {
  int32_t rows = 0;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (edge.active() && edge.kind != FactorKind::kMetric)
      rows += is_pose_factor(edge.kind) ? kTangentDim : 1;
  }
  for (int32_t node = 0; node < graph.node_end(); ++node) {
    const bool is_pose = graph.has_node(node) && graph.node(node).kind != NodeKind::kMetre;
    if (is_pose && !graph.node(node).fixed) rows -= kTangentDim;
  }
  return rows;
}

/// Cost of metric edges.
double metric_cost(const Graph& graph) {
  double cost = 0.0;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (!edge.active() || edge.kind != FactorKind::kMetric) continue;
    cost += robust_cost(edge.kernel, edge_norm_squared(graph, edge)).cost;
  }
  return cost;
}

}  // namespace

// A new window says nothing about the skeleton, which only loops tie together: it waits for the
// next of those, or for a call without anything new.
Status Session::optimize(int32_t max_iterations, OptimizeReport* report) {
  *report = OptimizeReport();
  if (!holds(show_metres())) return Status::kInternal;
  const uint64_t revision_before = map_.graph.revision();
  for (int32_t node = 0; node < map_.graph.node_end(); ++node)
    before_[node] = map_.graph.pose(node);
  LmOptions options;
  options.max_iterations = max_iterations > 0 ? max_iterations : map_.config.max_iterations;
  options.least_move = kStillMove;
  options.relinearize = kRelinearize;
  options.hold_skeleton = window_came_ && !watch_.has_news() && !skeleton_.nodes().empty();
  Status status = Status::kOk;
  do {
    if (!holds(gauge_.apply(&map_.graph))) return Status::kInternal;
    status = solver_.optimize(&map_.graph, options, &report->lm);
  } while (status == Status::kCapacity && skeleton_.untangle());
  refuse_late_windows();
  report->keyframes = live_nodes();
  report->submaps = map_.graph.node_count() - live_nodes() - map_.metric.metres();
  describe_bad_node(report);
  if (status == Status::kNotReady || status == Status::kCapacity) return status;
  ++counts_.optimizations;
  window_came_ = false;
  if (is_ok(status)) {
    watch_.news_solved();
  } else {
    watch_.note_news();
  }
  describe_changes(revision_before, report);
  skeleton_.watch_loops(counts_.optimizations);
  if (!holds(gauge_.apply(&map_.graph))) return Status::kInternal;
  const int32_t freedom = degrees_of_freedom(map_.graph);
  const double cost = report->lm.final_cost - metric_cost(map_.graph);
  const double variance = freedom > 0 ? 2.0 * cost / freedom : 1.0;
  if (freedom >= kTellingFreedom) map_.metric.set_unit_variance(variance);
  variance_factor_ = std::max(variance, told_variance());
  solved_revision_ = map_.graph.revision();
  distances_.note_solved();
  measure_new_metres();
  return status;
}

/// @param revision_before of the graph when before_ was taken
void Session::describe_changes(uint64_t revision_before, OptimizeReport* report) {
  const auto moved = [&](int32_t node) {
    if ((map_.graph.changes_since(node, revision_before) & kNodeMoved) == 0) return false;
    const Sim3 move = between(before_[node], map_.graph.pose(node));
    return sim3_log(move).cwiseAbs().maxCoeff() > kLeastMove;
  };
  const auto describe = [&](int32_t submap, const KeyframeRange& owned) {
    const int32_t node = map_.submaps[submap].place.node;
    const int32_t first = std::max(owned.first, map_.keyframes.first());
    if (owned.last < first || !moved(node)) return;
    note_changed(first, owned.last, report);
  };
  for (const SkeletonNode& node : skeleton_.nodes()) describe(node.submap, node.owned);
  for (const int32_t id : skeleton_.windows()) describe(id, map_.submaps[id].owned);
  int32_t newest = -1;
  for (int32_t id = skeleton_.live_from(); id < map_.keyframes.size(); ++id) {
    const int32_t node = map_.keyframes[id].node;
    if (node < 0) continue;
    newest = id;
    if (moved(node)) note_changed(id, id, report);
  }
  if (newest < 0) return;
  const Sim3& before = before_[map_.keyframes[newest].node];
  const Sim3& after = map_.graph.pose(map_.keyframes[newest].node);
  const Vec7 jump = sim3_log(between(before, after));
  report->jump_translation = (after.t - before.t).norm();
  report->jump_rotation = jump.segment<3>(3).norm();
  report->jump_log_scale = jump[6];
  const bool past_moved = report->first_changed >= 0 && report->first_changed < newest;
  if (past_moved) ++counts_.map_revision;
}

void Session::describe_bad_node(OptimizeReport* report) const {
  if (report->lm.bad_node < 0) return;
  for (int32_t id = skeleton_.live_from(); id < map_.keyframes.size(); ++id) {
    if (map_.keyframes[id].node == report->lm.bad_node) report->bad_keyframe = id;
  }
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (submap.place.own_node && submap.place.node == report->lm.bad_node)
      report->bad_submap = submap.id;
  }
}

}  // namespace unisim
