// SPDX-License-Identifier: MIT
// A skeleton at its capacity: neighbours in time become one rigid node.
#include <algorithm>

#include "core/base/math.hpp"
#include "core/base/positive_definite.hpp"
#include "core/graph/chain_transfer.hpp"
#include "core/map/view_edges.hpp"
#include "core/skeleton/skeleton.hpp"

namespace unisim {
namespace {

// The newest skeleton nodes still hold the window: they are merged last.
constexpr int32_t kFresh = 3;

bool joins(const Edge& edge, int32_t a, int32_t b) {
  return (edge.a == a && edge.b == b) || (edge.a == b && edge.b == a);
}

/// Information of the links of time between a and its successor b.
Mat7 information_between(const Graph& graph, int32_t a, int32_t b) {
  Mat7 Lambda = Mat7::Zero();
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    if (!graph.has_edge(id)) continue;
    const Edge& edge = graph.edge(id);
    const bool is_link = edge.kind == FactorKind::kChain && edge.origin == EdgeOrigin::kWindow;
    if (is_link && edge.a == a && edge.b == b) Lambda += graph.link(edge).Lambda;
  }
  return Lambda;
}

/// Of the link of time between a and its successor b; nothing is known of it: none.
Mat7 covariance_between(const Graph& graph, int32_t a, int32_t b) {
  const Mat7 Lambda = information_between(graph, a, b);
  return Lambda.trace() > 0.0 ? inverse_of_positive(Lambda) : Mat7(Mat7::Zero());
}

}  // namespace

/// The last of the nodes is the one too many: there is room for it while it is dealt with.
void Skeleton::merge_surplus() {
  while (!map_.broken() && nodes_.full()) {
    const int32_t k = cheapest_merge();
    if (k < 0) {
      forget_part();
    } else {
      merge(k);
    }
  }
}

/// Neighbours that carry the fewest windows, the older ones where that is equal. Segments are not
/// merged: what lies between them is not known. -1: none.
int32_t Skeleton::cheapest_merge() const {
  int32_t best = -1;
  const auto windows = [&](int32_t k) { return nodes_[k].windows + nodes_[k + 1].windows; };
  for (int32_t k = 0; k + 1 < nodes_.size() - kFresh; ++k) {
    const int32_t segment = map_.submaps[nodes_[k].submap].segment;
    if (map_.submaps[nodes_[k + 1].submap].segment != segment) continue;
    if (best < 0 || windows(k) < windows(best)) best = k;
  }
  return best;
}

/// Node a of the one at k absorbs node b of the next.
void Skeleton::merge(int32_t k) {
  const int32_t a = map_.submaps[nodes_[k].submap].place.node;
  const int32_t b = map_.submaps[nodes_[k + 1].submap].place.node;
  const Sim3 T_a_b = between(map_.graph.pose(a), map_.graph.pose(b));
  merge_metric(a, b, T_a_b);
  move_chains(a, b, T_a_b);
  detach_loop_views(b);
  hang_submaps(a, b, T_a_b);
  if (!map_.holds(map_.graph.remove_node(b))) return;
  attach_loop_views();
  loop_edges_.fuse_at(a);

  SkeletonNode& first = nodes_[k];
  const SkeletonNode& second = nodes_[k + 1];
  Retired merged;
  merged.submap = second.submap;
  merged.anchor = first.submap;
  merged.T = T_a_b;
  merged.segment = map_.submaps[first.submap].segment;
  outbox_.add_merge(merged);
  first.windows += second.windows;
  first.owned.include(second.owned);
  erase(k + 1);
}

void Skeleton::erase(int32_t k) {
  for (; k + 1 < nodes_.size(); ++k) nodes_[k] = nodes_[k + 1];
  nodes_.pop_back();
}

/// What hung on node b hangs on a.
void Skeleton::hang_submaps(int32_t a, int32_t b, const Sim3& T_a_b) {
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    SubmapPlace& place = map_.submaps.at(k).place;
    if (place.node != b) continue;
    place.node = a;
    place.T_node_submap = T_a_b * place.T_node_submap;
    place.own_node = false;
  }
}

/// What is known of the unit of b is known of that of a, less surely.
void Skeleton::merge_metric(int32_t a, int32_t b, const Sim3& T_a_b) {
  if (!map_.metric.evidence(b).known()) return map_.metric.forget(b);
  const double variance = covariance_between(map_.graph, a, b)(6, 6);
  map_.metric.merge(b, a, math::log(T_a_b.s), variance * map_.metric.unit_variance());
}

/// Chain edges of b go on from a, less sure by what the link between the two was unsure. Those
/// between a and b go with b.
void Skeleton::move_chains(int32_t a, int32_t b, const Sim3& T_a_b) {
  const Mat7 covariance = covariance_between(map_.graph, a, b);
  for (int32_t id = 0; id < map_.graph.edge_end(); ++id) {
    if (!map_.graph.has_edge(id)) continue;
    const Edge edge = map_.graph.edge(id);
    if (edge.kind != FactorKind::kChain || (edge.a != b && edge.b != b)) continue;
    const int32_t slot = loop_edges_.slot_of(id);
    if (joins(edge, a, b)) {
      if (slot >= 0) loop_edges_.release(slot, -1);
      continue;
    }
    const ChainLink link = map_.graph.link(edge);
    const bool first = edge.a == b;
    ChainLink moved =
        first ? move_first_end(link, T_a_b, covariance) : move_second_end(link, T_a_b, covariance);
    // Informations at the end of the range of numbers do not survive two inversions.
    if (!valid_link(moved)) moved.Lambda = link.Lambda;
    const int32_t made = replace_chain(map_, id, first ? a : edge.a, first ? edge.b : a, moved);
    if (slot >= 0) loop_edges_[slot].edge = made;
  }
}

/// Edges of live loops to a node that is about to go.
void Skeleton::detach_loop_views(int32_t node) {
  for (const int32_t loop : loops_) {
    const Submap& submap = map_.submaps[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = map_.submaps.view(submap, k);
      const int32_t edge = view.bridge >= 0 ? view.bridge : view.anchor;
      if (edge >= 0 && map_.graph.edge(edge).b == node) drop_view_edges(map_, &view);
    }
  }
}

/// A view whose keyframe is no longer kept cannot be held any more.
void Skeleton::attach_loop_views() {
  for (const int32_t loop : loops_) {
    const Submap& submap = map_.submaps[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = map_.submaps.view(submap, k);
      if (!view.used || view.bridge >= 0 || view.anchor >= 0) continue;
      view.used = map_.keyframes.has(view.keyframe);
      if (view.used) attach(submap, &view);
    }
  }
}

}  // namespace unisim
