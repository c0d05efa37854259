// SPDX-License-Identifier: MIT
// A skeleton at its capacity: neighbours in time become one rigid node.
#include <algorithm>

#include "core/base/positive_definite.hpp"
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
  while (!broken_ && skeleton_.size() > skeleton_capacity_) {
    const int32_t place = cheapest_merge();
    if (place < 0) {
      forget_part();
    } else {
      merge_skeleton(place);
    }
  }
}

/// Neighbours that carry the fewest windows, the older ones where that is equal. Segments are not
/// merged: what lies between them is not known. -1: none.
int32_t Session::cheapest_merge() const {
  int32_t best = -1;
  const auto windows = [&](int32_t k) { return skeleton_[k].windows + skeleton_[k + 1].windows; };
  for (int32_t k = 0; k + 1 < skeleton_.size() - kFresh; ++k) {
    const int32_t segment = submaps_[skeleton_[k].submap].segment;
    if (submaps_[skeleton_[k + 1].submap].segment != segment) continue;
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
  hang_submaps(a, b, T_a_b);
  if (!holds(graph_.remove_node(b))) return;
  attach_loop_views();
  fuse_loop_edges(a);

  SkeletonNode& first = skeleton_[place];
  const SkeletonNode& second = skeleton_[place + 1];
  Retired merge;
  merge.submap = second.submap;
  merge.anchor = first.submap;
  merge.T = T_a_b;
  merge.segment = submaps_[first.submap].segment;
  merges_[merges_made_++ % merges_.size()] = merge;
  first.windows += second.windows;
  if (first.first_owned < 0) first.first_owned = second.first_owned;
  first.last_owned = std::max(first.last_owned, second.last_owned);
  erase_skeleton(place + 1);
}

void Session::erase_skeleton(int32_t place) {
  for (int32_t k = place; k + 1 < skeleton_.size(); ++k) skeleton_[k] = skeleton_[k + 1];
  skeleton_.pop_back();
}

/// What hung on node b hangs on a.
void Session::hang_submaps(int32_t a, int32_t b, const Sim3& T_a_b) {
  for (int32_t k = 0; k < submaps_.size(); ++k) {
    Submap& submap = submaps_.at(k);
    if (submap.node != b) continue;
    submap.node = a;
    submap.T_node_submap = T_a_b * submap.T_node_submap;
    submap.own_node = false;
  }
}

/// Edges of b go on from a, less sure by what the removed link was unsure.
void Session::move_chain_edges(int32_t a, int32_t b, const Sim3& T_a_b) {
  Mat7 Lambda = Mat7::Zero();
  for (int32_t id = 0; id < graph_.edge_end(); ++id) {
    if (!graph_.has_edge(id)) continue;
    const Edge& edge = graph_.edge(id);
    const bool is_link = edge.kind == FactorKind::kChain && edge.origin == EdgeOrigin::kWindow;
    if (is_link && edge.a == a && edge.b == b) {
      Lambda += graph_.link(edge).Lambda;
    }
  }
  const bool known = Lambda.trace() > 0.0;
  const Mat7 covariance = known ? inverse_of_positive(Lambda) : Mat7(Mat7::Zero());
  for (int32_t id = 0; id < graph_.edge_end(); ++id) {
    if (!graph_.has_edge(id)) continue;
    const Edge edge = graph_.edge(id);
    if (edge.kind != FactorKind::kChain || (edge.a != b && edge.b != b)) continue;
    const int32_t place = loop_edge_at(id);
    if (joins(edge, a, b)) {
      if (place >= 0) release_loop_edge(place, -1);
      continue;
    }
    const ChainLink link = graph_.link(edge);
    const bool first = edge.a == b;
    ChainLink moved =
        first ? move_first_end(link, T_a_b, covariance) : move_second_end(link, T_a_b, covariance);
    // Informations at the end of the range of numbers do not survive two inversions.
    if (!valid_link(moved)) moved.Lambda = link.Lambda;
    const int32_t made = replace_chain(id, first ? a : edge.a, first ? edge.b : a, moved);
    if (place >= 0) loop_edges_[place].edge = made;
  }
}

/// @return the edge that took its place
int32_t Session::replace_chain(int32_t id, int32_t a, int32_t b, const ChainLink& link) {
  const Edge edge = graph_.edge(id);
  const EdgeWeight weight = edge.given_weight();
  int32_t made = -1;
  holds(graph_.remove_edge(id));
  if (!holds(graph_.add_chain(a, b, link, weight, &made))) return id;
  holds(graph_.set_suspended(made, edge.suspended));
  return made;
}

void Session::detach_loop_views(int32_t node) {
  const auto drop = [&](int32_t* id) {
    if (*id < 0 || graph_.edge(*id).b != node) return;
    holds(graph_.remove_edge(*id));
    *id = -1;
  };
  for (const int32_t loop : live_loops_) {
    const Submap& submap = submaps_[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      drop(&submaps_.view(submap, k).bridge);
      drop(&submaps_.view(submap, k).anchor);
    }
  }
}

/// A view whose keyframe is no longer kept cannot be held any more.
void Session::attach_loop_views() {
  for (const int32_t loop : live_loops_) {
    const Submap& submap = submaps_[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = submaps_.view(submap, k);
      if (!view.used || view.bridge >= 0 || view.anchor >= 0) continue;
      view.used = keyframes_.has(view.keyframe);
      if (view.used) attach_view(submap, &view);
    }
  }
}

}  // namespace unisim
