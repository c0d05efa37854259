// SPDX-License-Identifier: MIT
// Windows that leave the sliding window: keyframes become rigid parts of their submap, what lies
// between two submaps becomes one chain edge.
#include <algorithm>
#include <cmath>

#include "core/session.hpp"

namespace unisim {
namespace {

/// The same factor between two other nodes; its kind matters no more.
Status copy_edge(const Graph& from, const Edge& edge, int32_t a, int32_t b, Graph* to) {
  const EdgeWeight weight = edge.given_weight();
  int32_t id = -1;
  if (!is_pose_factor(edge.kind)) return to->add_scale(a, b, edge.log_ratio, weight, &id);
  const Sim3& P = from.measurement(edge.P);
  if (edge.Q < 0) return to->add_two_view(a, b, P, weight, &id);
  return to->add_tie(a, b, P, from.measurement(edge.Q), weight, &id);
}

}  // namespace

void Session::retire_surplus(int32_t newest) {
  if (broken_) return;
  if (!live_windows_.push_back(newest)) holds(Status::kInternal);
  for (int32_t k = live_windows_.size() - 1; k > 0; --k) {
    int32_t& older = live_windows_[k - 1];
    if (submaps_[older].window_first <= submaps_[live_windows_[k]].window_first) break;
    std::swap(older, live_windows_[k]);
  }
  while (!broken_ && live_windows_.size() > config_.window_submaps) retire_oldest();
}

void Session::retire_oldest() {
  const int32_t m = live_windows_[0];
  const int32_t n = live_windows_[1];
  ChainLink link;
  const bool linked = condense_windows(submaps_[m], submaps_[n], &link);
  const int32_t node_m = submaps_[m].node;
  const int32_t node_n = submaps_[n].node;
  retire_submap(m, n, submaps_[n].window_first);
  if (linked && !broken_) add_link(node_m, node_n, link);
  retire_loops();
  bound_skeleton();
}

/// No keyframe of the window stays but the newest settled one: nothing has come for a ring's
/// length.
void Session::retire_last() {
  while (!broken_ && live_windows_.size() > 1) retire_oldest();
  if (broken_) return;
  if (live_windows_.empty()) {
    holds(Status::kInternal);
    return;
  }
  const int32_t last = live_windows_[0];
  retire_submap(last, last, settled_);
  retire_loops();
  bound_skeleton();
}

/// Window m, the oldest, becomes a node of the skeleton; keyframes before `end` hang on it or on n.
void Session::retire_submap(int32_t m, int32_t n, int32_t end) {
  Submap& old = submaps_[m];
  drop_edges(m);
  if (!holds(graph_.set_kind(old.node, NodeKind::kSkeleton))) return;
  old.retired = true;
  submaps_.release_views(&old);
  for (int32_t k = 0; k + 1 < live_windows_.size(); ++k) live_windows_[k] = live_windows_[k + 1];
  live_windows_.pop_back();
  ++counts_.retired_windows;
  if (!skeleton_.push_back({m, 1, old.first_owned, old.last_owned})) holds(Status::kInternal);
  const int32_t first = std::max(live_from_, keyframes_.first());
  for (int32_t id = first; id < end; ++id) retire_keyframe(id, m, n);
  live_from_ = std::max(live_from_, end);
  drop_windows_before(live_from_);
}

/// A chain beyond the declared number of edges is left out: the gauge holds what it would have.
void Session::add_link(int32_t a, int32_t b, const ChainLink& link) {
  const RobustKernel kernel = {RobustKernelKind::kHuber, config_.huber_delta};
  int32_t edge = -1;
  const Status status =
      graph_.add_chain(a, b, link, {1.0, 1.0, kernel, EdgeOrigin::kWindow}, &edge);
  if (status != Status::kCapacity) holds(status);
}

/// Relative pose of two neighbouring windows out of everything between their centres but loops.
/// false: nothing joins them there.
bool Session::condense_windows(const Submap& m, const Submap& n, ChainLink* link) {
  if (!load_between(m, n)) {
    guess_link(m, n, link);
    return m.segment == n.segment;
  }
  return condenser_.condense(local_node_[m.node], local_node_[n.node], link);
}

/// false: more keyframes between the centres than the condenser takes.
bool Session::load_between(const Submap& m, const Submap& n) {
  condenser_.clear();
  Graph& local = condenser_.graph();
  for (int32_t& node : local_node_) node = -1;
  const Sim3 T_world_m = graph_.pose(m.node);
  const auto add = [&](NodeKind kind, int32_t node) {
    return is_ok(local.add_node(kind, between(T_world_m, graph_.pose(node)), &local_node_[node]));
  };
  bool fits = add(NodeKind::kSubmap, m.node) && add(NodeKind::kSubmap, n.node);
  const int32_t first = m.origin_keyframe;
  const int32_t last = n.origin_keyframe;
  for (int32_t id = std::min(first, last); fits && id <= std::max(first, last); ++id) {
    const int32_t node = keyframes_.has(id) ? keyframes_[id].node : -1;
    if (node >= 0) fits = add(NodeKind::kKeyframe, node);
  }
  for (int32_t id = 0; fits && id < graph_.edge_end(); ++id) {
    const Edge& edge = graph_.edge(id);
    if (!edge.active() || edge.origin == EdgeOrigin::kLoop || edge.kind == FactorKind::kChain) {
      continue;
    }
    const int32_t a = local_node_[edge.a];
    const int32_t b = local_node_[edge.b];
    if (a >= 0 && b >= 0) fits = is_ok(copy_edge(graph_, edge, a, b, &local));
  }
  return fits;
}

/// A stretch too long to condense, windows refused in a row: where it is now, as sure as that many
/// two-view edges.
void Session::guess_link(const Submap& m, const Submap& n, ChainLink* link) const {
  const int32_t first = m.origin_keyframe;
  const int32_t last = n.origin_keyframe;
  const double information = config_.factor(FactorKind::kTwoView).information;
  link->Z_a_b = between(graph_.pose(m.node), graph_.pose(n.node));
  link->Lambda = Mat7::Identity() * (information / std::max(1, std::abs(last - first)));
}

void Session::drop_edges(int32_t id) {
  const Submap& submap = submaps_[id];
  const auto drop = [&](int32_t* edge) {
    if (*edge >= 0) holds(graph_.remove_edge(*edge));
    *edge = -1;
  };
  for (int32_t k = 0; k < submap.count; ++k) {
    SubmapView& view = submaps_.view(submap, k);
    drop(&view.bridge);
    drop(&view.anchor);
  }
  for (SharedKeyframe& shared : submaps_.shared()) {
    if (shared.m != id && shared.n != id) continue;
    drop(&shared.tie);
    int32_t scale = shared.scale;
    if (scale < 0) continue;
    // One scale edge stands for all shared keyframes of the pair.
    for (SharedKeyframe& same : submaps_.shared()) {
      if (same.scale == scale) same.scale = -1;
    }
    drop(&scale);
  }
  submaps_.drop_shared(id);
  count_window_pairs();
}

void Session::count_window_pairs() {
  const Span<const SharedKeyframe> shared = submaps_.shared();
  window_pairs_ = 0;
  for (int32_t k = 0; k < shared.size(); ++k) {
    bool counted = false;
    for (int32_t i = 0; i < k; ++i) {
      counted = counted || (shared[i].m == shared[k].m && shared[i].n == shared[k].n);
    }
    window_pairs_ += counted ? 0 : 1;
  }
}

void Session::retire_keyframe(int32_t id, int32_t m, int32_t n) {
  Keyframe& keyframe = keyframes_[id];
  if (broken_ || keyframe.node < 0) return;
  const int32_t owner = owner_of(id, m, n);
  Submap& carrier = submaps_[owner];
  keyframe.T_owner_kf = between(submap_pose(carrier), graph_.pose(keyframe.node));
  keyframe.owner = owner;
  holds(graph_.remove_node(keyframe.node));
  keyframe.node = -1;
  note_owned(&carrier, id);
  ++counts_.retired_keyframes;
  --counts_.live_nodes;
  for (const int32_t loop : live_loops_) {
    const Submap& submap = submaps_[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = submaps_.view(submap, k);
      if (view.keyframe == id && view.used) attach_view(submap, &view);
    }
  }
}

void Session::note_owned(Submap* carrier, int32_t keyframe) {
  const auto note = [keyframe](int32_t* first, int32_t* last) {
    *first = *first < 0 ? keyframe : std::min(*first, keyframe);
    *last = std::max(*last, keyframe);
  };
  note(&carrier->first_owned, &carrier->last_owned);
  if (!carrier->retired) return;
  for (int32_t k = skeleton_.size() - 1; k >= 0; --k) {
    if (submaps_[skeleton_[k].submap].node != carrier->node) continue;
    note(&skeleton_[k].first_owned, &skeleton_[k].last_owned);
    return;
  }
}

/// The window over it whose centre is nearest; without one the nearer of the two it lies between.
int32_t Session::owner_of(int32_t id, int32_t m, int32_t n) const {
  const int32_t best = keyframes_[id].best_submap;
  if (best >= 0 && submaps_.has(best) && !submaps_[best].is_loop) return best;
  const auto distance = [&](int32_t submap) {
    return std::abs(submaps_[submap].origin_keyframe - id);
  };
  const int32_t segment = keyframes_[id].segment;
  const bool m_fits = submaps_[m].segment == segment;
  const bool n_fits = submaps_[n].segment == segment;
  if (m_fits != n_fits) return m_fits ? m : n;
  return distance(m) <= distance(n) ? m : n;
}

/// Predictions that come in another order: windows over retired keyframes are asked for no more.
void Session::drop_windows_before(int32_t keyframe) {
  Window dropped;
  while (windows_.drop_before(keyframe, &dropped)) refuse_window(dropped, RefusalReason::kLate);
}

}  // namespace unisim
