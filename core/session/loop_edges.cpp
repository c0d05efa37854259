// SPDX-License-Identifier: MIT
// Condensed loops: a bounded number of chain edges, those that agree fused, the weakest dropped.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/graph/chain_transfer.hpp"
#include "core/session.hpp"

namespace unisim {
namespace {

// Square of the whitened difference below which two loops between the same nodes say the same.
constexpr double kLargestDisagreement = 1.0;

}  // namespace

int32_t Session::loop_edge_at(int32_t edge) const {
  for (int32_t place = 0; place < loop_edges_.size(); ++place) {
    if (loop_edges_[place].edge == edge) return place;
  }
  return -1;
}

void Session::add_loop_edge(int32_t a, int32_t b, const ChainLink& link, Submap* loop) {
  const int32_t same = loop->health.suspended ? -1 : fusible_edge(a, b, link, -1);
  if (same >= 0) {
    fuse_loop_edge(same, link);
    ++loop_edges_[same].loops;
    loop_edges_[same].loop = loop->id;
    loop->loop_edge = same;
    return;
  }
  int32_t place = loop_edge_at(-1);
  if (place < 0 && loop_edges_.size() < loop_edges_.capacity()) {
    place = loop_edges_.size();
    loop_edges_.resize(place + 1);
  }
  if (place < 0) {
    place = weakest_loop_edge();
    drop_loop_edge(place);
  }
  const RobustKernel kernel = {RobustKernelKind::kGemanMcClure, config_.loop_delta};
  LoopEdge made;
  if (!holds(graph_.add_chain(a, b, link, {1.0, 1.0, kernel, EdgeOrigin::kLoop}, &made.edge)))
    return;
  holds(graph_.set_suspended(made.edge, loop->health.suspended));
  if (loop->health.suspended) ++counts_.suspended_loops;
  made.loop = loop->id;
  made.loops = 1;
  made.health = loop->health;
  loop_edges_[place] = made;
  loop->loop_edge = place;
}

/// Loop edge between the same nodes that says the same. -1: none.
int32_t Session::fusible_edge(int32_t a, int32_t b, const ChainLink& link, int32_t but) const {
  for (int32_t place = 0; place < loop_edges_.size(); ++place) {
    const LoopEdge& other = loop_edges_[place];
    if (place == but || other.edge < 0 || other.health.suspended) continue;
    const Edge& edge = graph_.edge(other.edge);
    if (edge.a != a || edge.b != b) continue;
    if (disagreement_squared(link, graph_.link(edge)) <= kLargestDisagreement) return place;
  }
  return -1;
}

void Session::fuse_loop_edge(int32_t place, const ChainLink& link) {
  const Edge edge = graph_.edge(loop_edges_[place].edge);
  const ChainLink fused = fuse(graph_.link(edge), link);
  // Informations at the end of the range of numbers do not survive a sum.
  if (!valid_link(fused)) return;
  loop_edges_[place].edge = replace_chain(loop_edges_[place].edge, edge.a, edge.b, fused);
}

/// Loops between the same two nodes that agree become one; those that do not stay rivals.
void Session::fuse_loop_edges(int32_t node) {
  for (int32_t place = 0; place < loop_edges_.size(); ++place) {
    const LoopEdge one = loop_edges_[place];
    if (one.edge < 0 || one.health.suspended) continue;
    const Edge edge = graph_.edge(one.edge);
    if (edge.a != node && edge.b != node) continue;
    const ChainLink link = graph_.link(edge);
    const int32_t other = fusible_edge(edge.a, edge.b, link, place);
    if (other < 0) continue;
    fuse_loop_edge(other, link);
    loop_edges_[other].loops += one.loops;
    loop_edges_[other].loop = std::max(loop_edges_[other].loop, one.loop);
    holds(graph_.remove_edge(one.edge));
    release_loop_edge(place, other);
  }
}

/// The place is free; its loops belong to another edge from now on, or to none (-1).
void Session::release_loop_edge(int32_t place, int32_t into) {
  if (loop_edges_[place].health.suspended) --counts_.suspended_loops;
  loop_edges_[place] = LoopEdge();
  for (int32_t k = 0; k < submaps_.size(); ++k) {
    if (submaps_.at(k).loop_edge == place) submaps_.at(k).loop_edge = into;
  }
}

void Session::drop_loop_edge(int32_t place) {
  const LoopEdge dropped = loop_edges_[place];
  LogLine line;
  line << "loop " << dropped.loop
       << " dropped: loop edges at their limit, another says much the same";
  line.send(config_.log, LogLevel::kInfo);
  counts_.loops_dropped += dropped.loops;
  for (int32_t k = 0; k < submaps_.size(); ++k) {
    if (submaps_.at(k).loop_edge == place) submaps_.at(k).removed = true;
  }
  holds(graph_.remove_edge(dropped.edge));
  release_loop_edge(place, -1);
}

/// A suspended one, else of the two that join most nearly the same places the less sure: what it
/// says the other says too. Measured: moving its ends there and fusing the two is no better.
/// @return its place; -1: there are none
int32_t Session::weakest_loop_edge() {
  for (int32_t k = 0; k < skeleton_.size(); ++k) place_[submaps_[skeleton_[k].submap].node] = k;
  for (int32_t k = 0; k < live_windows_.size(); ++k) {
    place_[submaps_[live_windows_[k]].node] = skeleton_.size() + k;
  }
  int32_t weakest = -1;
  int32_t nearest = std::numeric_limits<int32_t>::max();
  for (int32_t one = 0; one < loop_edges_.size(); ++one) {
    if (loop_edges_[one].edge < 0) continue;
    if (loop_edges_[one].health.suspended) return one;
    if (weakest < 0) weakest = one;
    const Edge& edge = graph_.edge(loop_edges_[one].edge);
    for (int32_t other = one + 1; other < loop_edges_.size(); ++other) {
      if (loop_edges_[other].edge < 0) continue;
      const Edge& rival = graph_.edge(loop_edges_[other].edge);
      const int32_t apart =
          std::abs(place_[edge.a] - place_[rival.a]) + std::abs(place_[edge.b] - place_[rival.b]);
      if (apart >= nearest) continue;
      nearest = apart;
      const bool surer = graph_.link(edge).Lambda.trace() > graph_.link(rival).Lambda.trace();
      weakest = surer ? other : one;
    }
  }
  return weakest;
}

/// Loops tangle the graph beyond the solver's memory: a few give way. false: none is left.
bool Session::untangle() {
  constexpr int32_t kAtATime = 8;
  bool dropped = false;
  for (int32_t k = 0; k < kAtATime; ++k) {
    const int32_t place = weakest_loop_edge();
    if (place < 0) break;
    drop_loop_edge(place);
    dropped = true;
  }
  if (dropped) return true;
  if (!slides() || live_loops_.empty()) return false;
  condense_early(live_loops_[0]);
  return !broken_;
}

}  // namespace unisim
