// SPDX-License-Identifier: MIT
// A skeleton at its capacity: neighbours in time become one rigid node.
#include <algorithm>

#include "core/graph/chain_transfer.hpp"
#include "core/session.hpp"

namespace unisim {
namespace {

// The newest skeleton nodes still hold the window: they are merged last.
constexpr int32_t kFresh = 3;

bool joins(const Edge& edge, int32_t a, int32_t b) {
  return (edge.a == a && edge.b == b) || (edge.a == b && edge.b == a);
}

}  // namespace

void Session::bound_skeleton() {
  if (config_.skeleton_capacity == 0) return;
  while (!broken_ && skeleton_.size() > config_.skeleton_capacity) {
    const int32_t place = cheapest_merge();
    if (place < 0) return;
    merge_skeleton(place);
  }
}

/// Neighbours that carry the fewest windows, the older ones where that is equal. Segments are not
/// merged: what lies between them is not known. -1: none.
int32_t Session::cheapest_merge() const {
  int32_t best = -1;
  const auto windows = [&](int32_t k) { return skeleton_[k].windows + skeleton_[k + 1].windows; };
  for (int32_t k = 0; k + 1 < skeleton_.size() - kFresh; ++k) {
    const int32_t segment = segment_of(submaps_[skeleton_[k].submap]);
    if (segment_of(submaps_[skeleton_[k + 1].submap]) != segment) continue;
    if (best < 0 || windows(k) < windows(best)) best = k;
  }
  return best;
}

/// Node b of the second is absorbed by node a of the first.
void Session::merge_skeleton(int32_t place) {
  const int32_t a = submaps_[skeleton_[place].submap].node;
  const int32_t b = submaps_[skeleton_[place + 1].submap].node;
  const Sim3 T_a_b = between(graph_.pose(a), graph_.pose(b));
  move_chain_edges(a, b, T_a_b);
  detach_loop_views(b);
  for (int32_t id = 0; id < submaps_.size(); ++id) {
    Submap& submap = submaps_[id];
    if (submap.node != b) continue;
    submap.node = a;
    submap.T_node_submap = T_a_b * submap.T_node_submap;
    submap.own_node = false;
  }
  if (!holds(graph_.remove_node(b))) return;
  attach_loop_views();
  fuse_loop_edges(a);
  skeleton_[place].windows += skeleton_[place + 1].windows;
  for (int32_t k = place + 1; k + 1 < skeleton_.size(); ++k) skeleton_[k] = skeleton_[k + 1];
  skeleton_.pop_back();
}

/// Edges of b go on from a, less sure by what the removed link was unsure.
void Session::move_chain_edges(int32_t a, int32_t b, const Sim3& T_a_b) {
  Mat7 Lambda = Mat7::Zero();
  for (int32_t id = 0; id < graph_.edge_end(); ++id) {
    if (!graph_.has_edge(id)) continue;
    const Edge& edge = graph_.edge(id);
    const bool ordinary = edge.kernel.kind != RobustKernelKind::kGemanMcClure;
    if (edge.kind == FactorKind::kChain && ordinary && edge.a == a && edge.b == b) {
      Lambda += graph_.link(edge).Lambda;
    }
  }
  const bool known = Lambda.trace() > 0.0;
  const Mat7 covariance = known ? inverse_of_positive(Lambda) : Mat7(Mat7::Zero());
  for (int32_t id = 0; id < graph_.edge_end(); ++id) {
    if (!graph_.has_edge(id)) continue;
    const Edge edge = graph_.edge(id);
    if (edge.kind != FactorKind::kChain || (edge.a != b && edge.b != b)) continue;
    if (joins(edge, a, b)) continue;
    const ChainLink link = graph_.link(edge);
    const bool first = edge.a == b;
    ChainLink moved =
        first ? move_first_end(link, T_a_b, covariance) : move_second_end(link, T_a_b, covariance);
    // Informations at the end of the range of numbers do not survive two inversions.
    if (!valid_link(moved)) moved.Lambda = link.Lambda;
    replace_chain(id, first ? a : edge.a, first ? edge.b : a, moved);
  }
}

void Session::replace_chain(int32_t id, int32_t a, int32_t b, const ChainLink& link) {
  const Edge edge = graph_.edge(id);
  const EdgeWeight weight = {edge.information, edge.multiplier, edge.kernel};
  int32_t made = -1;
  holds(graph_.remove_edge(id));
  holds(graph_.add_chain(a, b, link, weight, &made));
}

void Session::detach_loop_views(int32_t node) {
  for (const int32_t loop : live_loops_) {
    const Submap& submap = submaps_[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = submaps_.view(submap, k);
      const Keyframe& keyframe = keyframes_[view.keyframe];
      if (!view.used || !keyframe.retired() || submaps_[keyframe.owner].node != node) continue;
      if (view.bridge >= 0) holds(graph_.remove_edge(view.bridge));
      if (view.anchor >= 0) holds(graph_.remove_edge(view.anchor));
      view.bridge = -1;
      view.anchor = -1;
    }
  }
}

void Session::attach_loop_views() {
  for (const int32_t loop : live_loops_) {
    const Submap& submap = submaps_[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = submaps_.view(submap, k);
      if (view.used && view.bridge < 0 && view.anchor < 0) attach_view(submap, &view);
    }
  }
}

/// Loops between the same two nodes that agree become one; those that do not stay rivals.
void Session::fuse_loop_edges(int32_t node) {
  const auto is_loop_edge = [&](int32_t id) {
    if (!graph_.has_edge(id)) return false;
    const Edge& edge = graph_.edge(id);
    return edge.kind == FactorKind::kChain && (edge.a == node || edge.b == node) &&
           edge.kernel.kind == RobustKernelKind::kGemanMcClure;
  };
  constexpr double kLargestDisagreement = 1.0;
  for (int32_t one = 0; one < graph_.edge_end(); ++one) {
    if (!is_loop_edge(one)) continue;
    for (int32_t other = one + 1; other < graph_.edge_end(); ++other) {
      if (!is_loop_edge(other)) continue;
      const Edge edge = graph_.edge(one);
      if (graph_.edge(other).a != edge.a || graph_.edge(other).b != edge.b) continue;
      const ChainLink first = graph_.link(edge);
      const ChainLink second = graph_.link(graph_.edge(other));
      if (disagreement_squared(first, second) > kLargestDisagreement) continue;
      const ChainLink fused = fuse(first, second);
      if (!valid_link(fused)) continue;
      holds(graph_.remove_edge(other));
      replace_chain(one, edge.a, edge.b, fused);
    }
  }
}

}  // namespace unisim
