// SPDX-License-Identifier: MIT
// Optimisation of the graph and what it changed; covariances.
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

bool moved(const Sim3& before, const Sim3& after) {
  return sim3_log(between(before, after)).cwiseAbs().maxCoeff() > kLeastMove;
}

void note_changed(int32_t first, int32_t last, OptimizeReport* report) {
  if (report->first_changed < 0 || first < report->first_changed) report->first_changed = first;
  report->last_changed = std::max(report->last_changed, last);
}

/// Rows of all active edges minus free unknowns.
int32_t degrees_of_freedom(const Graph& graph) {
  int32_t rows = 0;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (edge.active()) rows += is_pose_factor(edge.kind) ? kTangentDim : 1;
  }
  for (int32_t node = 0; node < graph.node_end(); ++node) {
    if (graph.has_node(node) && !graph.node(node).fixed) rows -= kTangentDim;
  }
  return rows;
}

}  // namespace

// A new window says nothing about the skeleton, which only loops tie together: it waits for the
// next of those, or for a call without anything new.
Status Session::optimize(int32_t max_iterations, OptimizeReport* report) {
  *report = OptimizeReport();
  for (int32_t node = 0; node < graph_.node_end(); ++node) before_[node] = graph_.pose(node);
  LmOptions options;
  options.max_iterations = max_iterations > 0 ? max_iterations : config_.max_iterations;
  options.least_move = kStillMove;
  options.relinearize = kRelinearize;
  options.hold_skeleton = window_came_ && !skeleton_is_due_ && !skeleton_.empty();
  Status status = Status::kOk;
  do {
    if (!holds(gauge_.apply(&graph_))) return Status::kInternal;
    status = solver_.optimize(&graph_, options, &report->lm);
  } while (status == Status::kCapacity && untangle());
  report->keyframes = counts_.live_nodes;
  report->submaps = graph_.node_count() - counts_.live_nodes;
  describe_bad_node(report);
  if (status == Status::kNotReady || status == Status::kCapacity) return status;
  ++counts_.optimizations;
  window_came_ = false;
  skeleton_is_due_ = !is_ok(status);
  describe_changes(report);
  judge_loops();
  if (!holds(gauge_.apply(&graph_))) return Status::kInternal;
  const int32_t freedom = degrees_of_freedom(graph_);
  variance_factor_ = freedom > 0 ? 2.0 * report->lm.final_cost / freedom : 1.0;
  solved_revision_ = graph_.revision();
  return status;
}

void Session::describe_changes(OptimizeReport* report) {
  const auto describe = [&](int32_t submap, int32_t first_owned, int32_t last_owned) {
    const int32_t node = submaps_[submap].node;
    const int32_t first = std::max(first_owned, keyframes_.first());
    if (last_owned < first || !moved(before_[node], graph_.pose(node))) return;
    note_changed(first, last_owned, report);
  };
  for (const SkeletonNode& node : skeleton_) {
    describe(node.submap, node.first_owned, node.last_owned);
  }
  for (const int32_t id : live_windows_) {
    describe(id, submaps_[id].first_owned, submaps_[id].last_owned);
  }
  int32_t newest = -1;
  for (int32_t id = live_from_; id < keyframes_.size(); ++id) {
    const int32_t node = keyframes_[id].node;
    if (node < 0) continue;
    newest = id;
    if (moved(before_[node], graph_.pose(node))) note_changed(id, id, report);
  }
  if (newest < 0) return;
  const Sim3& before = before_[keyframes_[newest].node];
  const Sim3& after = graph_.pose(keyframes_[newest].node);
  const Vec7 jump = sim3_log(between(before, after));
  report->jump_translation = (after.t - before.t).norm();
  report->jump_rotation = jump.segment<3>(3).norm();
  report->jump_log_scale = jump[6];
  const bool past_moved = report->first_changed >= 0 && report->first_changed < newest;
  if (past_moved) ++counts_.map_revision;
}

void Session::describe_bad_node(OptimizeReport* report) const {
  if (report->lm.bad_node < 0) return;
  for (int32_t id = live_from_; id < keyframes_.size(); ++id) {
    if (keyframes_[id].node == report->lm.bad_node) report->bad_keyframe = id;
  }
  for (int32_t k = 0; k < submaps_.size(); ++k) {
    const Submap& submap = submaps_.at(k);
    if (submap.own_node && submap.node == report->lm.bad_node) report->bad_submap = submap.id;
  }
}

Status Session::covariance(int32_t keyframe, Mat7* covariance) {
  if (keyframes_.gone(keyframe)) return Status::kRetired;
  if (!keyframes_.has(keyframe)) return Status::kInvalidArgument;
  const Keyframe& asked = keyframes_[keyframe];
  const int32_t node = asked.retired() ? submaps_[asked.owner].node : asked.node;
  if (node < 0 || graph_.revision() != solved_revision_) return Status::kNotReady;
  if (graph_.node(node).fixed) {
    covariance->setZero();
    return Status::kOk;
  }
  const Status status = solver_.marginal_covariance(graph_, node, covariance);
  if (!is_ok(status)) return status;
  if (asked.retired()) {
    // T = S X and S exp(d) X = S X exp(Ad(X^-1) d).
    const Mat7 Ad =
        sim3_adjoint((submaps_[asked.owner].T_node_submap * asked.T_owner_kf).inverse());
    *covariance = (Ad * *covariance * Ad.transpose()).eval();
  }
  *covariance *= variance_factor_;
  return status;
}

}  // namespace unisim
