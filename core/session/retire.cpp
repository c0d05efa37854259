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
  const EdgeWeight weight = {edge.information, edge.multiplier, edge.kernel};
  int32_t id = -1;
  if (!is_pose_factor(edge.kind)) return to->add_scale(a, b, edge.log_ratio, weight, &id);
  const Sim3& P = from.measurement(edge.P);
  if (edge.Q < 0) return to->add_two_view(a, b, P, weight, &id);
  return to->add_tie(a, b, P, from.measurement(edge.Q), weight, &id);
}

bool is_robust(const Edge& edge) { return edge.kernel.kind == RobustKernelKind::kGemanMcClure; }

}  // namespace

void Session::retire_surplus(int32_t newest) {
  if (broken_) return;
  if (submaps_[newest].is_loop) {
    if (!live_loops_.push_back(newest)) holds(Status::kInternal);
    return;
  }
  if (!live_windows_.push_back(newest)) holds(Status::kInternal);
  for (int32_t k = live_windows_.size() - 1; k > 0; --k) {
    int32_t& older = live_windows_[k - 1];
    if (submaps_[older].window_first <= submaps_[live_windows_[k]].window_first) break;
    std::swap(older, live_windows_[k]);
  }
  while (!broken_ && live_windows_.size() > config_.window_submaps) {
    retire_window(live_windows_[0], live_windows_[1]);
    for (int32_t k = 0; k + 1 < live_windows_.size(); ++k) live_windows_[k] = live_windows_[k + 1];
    live_windows_.pop_back();
    retire_loops();
    bound_skeleton();
  }
}

void Session::retire_window(int32_t m, int32_t n) {
  Submap& old = submaps_[m];
  const Submap& next = submaps_[n];
  ChainLink link;
  const bool linked = condense_windows(old, next, &link);
  drop_edges(m);
  if (!holds(graph_.set_kind(old.node, NodeKind::kSkeleton))) return;
  old.retired = true;
  ++counts_.retired_windows;
  if (!skeleton_.push_back({m, 1})) holds(Status::kInternal);
  for (int32_t id = live_from_; id < next.window_first; ++id) retire_keyframe(id, m, n);
  live_from_ = std::max(live_from_, next.window_first);
  if (linked) {
    const RobustKernel kernel = {RobustKernelKind::kHuber, config_.huber_delta};
    int32_t edge = -1;
    holds(graph_.add_chain(old.node, next.node, link, {1.0, 1.0, kernel}, &edge));
  }
  drop_windows_before(live_from_);
}

/// Relative pose of two neighbouring windows out of everything between their centres but loops.
/// false: nothing joins them there.
bool Session::condense_windows(const Submap& m, const Submap& n, ChainLink* link) {
  if (!load_between(m, n)) {
    guess_link(m, n, link);
    return segment_of(m) == segment_of(n);
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
  const int32_t first = submaps_.view(m, m.origin).keyframe;
  const int32_t last = submaps_.view(n, n.origin).keyframe;
  for (int32_t id = std::min(first, last); fits && id <= std::max(first, last); ++id) {
    const int32_t node = keyframes_[id].node;
    if (node >= 0) fits = add(NodeKind::kKeyframe, node);
  }
  for (int32_t id = 0; fits && id < graph_.edge_end(); ++id) {
    const Edge& edge = graph_.edge(id);
    if (!edge.active() || is_robust(edge) || edge.kind == FactorKind::kChain) continue;
    const int32_t a = local_node_[edge.a];
    const int32_t b = local_node_[edge.b];
    if (a >= 0 && b >= 0) fits = is_ok(copy_edge(graph_, edge, a, b, &local));
  }
  return fits;
}

/// A stretch too long to condense, windows refused in a row: where it is now, as sure as that many
/// two-view edges.
void Session::guess_link(const Submap& m, const Submap& n, ChainLink* link) const {
  const int32_t first = submaps_.view(m, m.origin).keyframe;
  const int32_t last = submaps_.view(n, n.origin).keyframe;
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
  if (carrier.first_owned < 0) carrier.first_owned = id;
  carrier.last_owned = std::max(carrier.last_owned, id);
  ++counts_.retired_keyframes;
  for (const int32_t loop : live_loops_) {
    const Submap& submap = submaps_[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = submaps_.view(submap, k);
      if (view.keyframe == id && view.used) attach_view(submap, &view);
    }
  }
}

/// The window over it whose centre is nearest; without one the nearer of the two it lies between.
int32_t Session::owner_of(int32_t id, int32_t m, int32_t n) const {
  const int32_t best = keyframes_[id].best_submap;
  if (best >= 0 && !submaps_[best].is_loop) return best;
  const auto distance = [&](int32_t submap) {
    return std::abs(submaps_.view(submaps_[submap], submaps_[submap].origin).keyframe - id);
  };
  const int32_t segment = keyframes_[id].segment;
  const bool m_fits = segment_of(submaps_[m]) == segment;
  const bool n_fits = segment_of(submaps_[n]) == segment;
  if (m_fits != n_fits) return m_fits ? m : n;
  return distance(m) <= distance(n) ? m : n;
}

/// Predictions that come in another order: windows over retired keyframes are asked for no more.
void Session::drop_windows_before(int32_t keyframe) {
  Window dropped;
  while (windows_.drop_before(keyframe, &dropped)) {
    ++counts_.submaps_refused;
    LogLine line;
    line << "window of keyframes " << dropped.first << ".." << dropped.last()
         << " given up: newer windows came first and its keyframes have retired";
    line.send(config_.log, LogLevel::kWarning);
  }
}

}  // namespace unisim
