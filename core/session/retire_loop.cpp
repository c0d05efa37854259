// SPDX-License-Identifier: MIT
// A loop whose keyframes have all retired becomes one chain edge between two windows.

#include "core/base/math.hpp"
#include "core/session.hpp"

namespace unisim {

void Session::retire_loops() {
  int32_t kept = 0;
  for (int32_t k = 0; k < live_loops_.size(); ++k) {
    const int32_t id = live_loops_[k];
    if (all_retired(submaps_[id])) {
      retire_loop(id);
    } else {
      live_loops_[kept++] = id;
    }
  }
  live_loops_.resize(kept);
}

bool Session::all_retired(const Submap& submap) const {
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = submaps_.view(submap, k);
    if (view.used && keyframes_.has(view.keyframe) && keyframes_[view.keyframe].node >= 0) {
      return false;
    }
  }
  return true;
}

/// Keyframes that have not retired are taken as rigid under the window they are nearest to.
void Session::condense_early(int32_t id) {
  if (live_windows_.empty() && skeleton_.empty()) close_stretch();
  int32_t kept = 0;
  for (const int32_t loop : live_loops_) {
    if (loop != id) live_loops_[kept++] = loop;
  }
  live_loops_.resize(kept);
  retire_loop(id);
}

void Session::retire_loop(int32_t id) {
  if (broken_) return;
  Submap& loop = submaps_[id];
  const int32_t split = split_view(loop);
  const int32_t a = main_node(loop, 0, split);
  const int32_t b = main_node(loop, split, loop.count);
  ChainLink link;
  const bool linked = a >= 0 && b >= 0 && a != b && condense_loop(loop, a, b, split, &link);
  const Sim3 T_world_loop = graph_.pose(loop.node);
  if (loop.health.suspended) --counts_.suspended_loops;
  holds(graph_.remove_node(loop.node));
  submaps_.release_views(&loop);
  ++counts_.retired_loops;
  const int32_t place = a >= 0 ? a : b;
  const int32_t carrier = place >= 0 ? place : node_under(loop.origin_keyframe);
  if (carrier < 0) {
    submaps_.erase(id);
    return;
  }
  loop.node = carrier;
  loop.T_node_submap = between(graph_.pose(carrier), T_world_loop);
  loop.own_node = false;
  loop.retired = true;
  if (linked && !loop.removed) add_loop_edge(a, b, link, &loop);
}

/// First view of the second place: behind the widest gap between keyframes that take part.
int32_t Session::split_view(const Submap& loop) const {
  int32_t before = -1;
  int32_t widest = 0;
  int32_t split = loop.count;
  for (int32_t k = 0; k < loop.count; ++k) {
    const SubmapView& view = submaps_.view(loop, k);
    if (!view.used || !keyframes_.has(view.keyframe)) continue;
    if (before >= 0 && view.keyframe - before > widest) {
      widest = view.keyframe - before;
      split = k;
    }
    before = view.keyframe;
  }
  return split;
}

/// Node that carries a keyframe, or will: that of the window over it or nearest to it. -1: none.
int32_t Session::node_under(int32_t keyframe) const {
  if (!keyframes_.has(keyframe)) return -1;
  const Keyframe& asked = keyframes_[keyframe];
  if (asked.retired()) return submaps_[asked.owner].node;
  int32_t best = asked.best_submap;
  if (best >= 0 && submaps_.has(best) && !submaps_[best].is_loop) return submaps_[best].node;
  best = -1;
  for (const int32_t id : live_windows_) {
    if (submaps_[id].segment != asked.segment) continue;
    if (best < 0 || std::abs(submaps_[id].origin_keyframe - keyframe) <
                        std::abs(submaps_[best].origin_keyframe - keyframe)) {
      best = id;
    }
  }
  return best < 0 ? -1 : submaps_[best].node;
}

/// Node on which most of the views begin .. end - 1 hang.
int32_t Session::main_node(const Submap& loop, int32_t begin, int32_t end) const {
  const auto node_of = [&](int32_t k) {
    const SubmapView& view = submaps_.view(loop, k);
    return view.used ? node_under(view.keyframe) : -1;
  };
  int32_t best = -1;
  int32_t most = 0;
  for (int32_t k = begin; k < end; ++k) {
    int32_t votes = 0;
    for (int32_t other = begin; other < end; ++other) votes += node_of(other) == node_of(k) ? 1 : 0;
    if (node_of(k) < 0 || votes <= most) continue;
    most = votes;
    best = node_of(k);
  }
  return best;
}

/// Small graph of nodes a, b and the loop. Views before `split` are rigid under a, the others under
/// b. It starts from what the loop says, not from the poses of the map: where the map has drifted
/// far, its poses could lead the solver to another minimum.
bool Session::condense_loop(const Submap& loop, int32_t a, int32_t b, int32_t split,
                            ChainLink* link) {
  condenser_.clear();
  Graph& local = condenser_.graph();
  const EdgeWeight bridge = edge_weight(FactorKind::kBridge, loop.multiplier, EdgeOrigin::kWindow);
  const EdgeWeight anchor =
      edge_weight(FactorKind::kScaleAnchor, loop.multiplier, EdgeOrigin::kWindow);
  const auto T_node_kf = [&](int32_t k) {
    return between(graph_.pose(k < split ? a : b), keyframe_pose(submaps_.view(loop, k).keyframe));
  };
  const auto takes_part = [&](int32_t k) {
    const SubmapView& view = submaps_.view(loop, k);
    return view.used && keyframes_.has(view.keyframe);
  };
  const auto middle = [&](int32_t begin, int32_t end) {
    int32_t best = -1;
    for (int32_t k = begin; k < end; ++k) {
      if (takes_part(k) && (best < 0 || k <= (begin + end) / 2)) best = k;
    }
    return best;
  };
  const int32_t at_a = middle(0, split);
  const int32_t at_b = middle(split, loop.count);
  const Sim3 T_a_loop = T_node_kf(at_a) * view_measurement(submaps_.view(loop, at_a)).inverse();
  const Sim3 T_a_b =
      T_a_loop * view_measurement(submaps_.view(loop, at_b)) * T_node_kf(at_b).inverse();
  int32_t local_a = -1;
  int32_t local_b = -1;
  int32_t local_loop = -1;
  bool fits = is_ok(local.add_node(NodeKind::kSubmap, Sim3(), &local_a)) &&
              is_ok(local.add_node(NodeKind::kSubmap, T_a_b, &local_b)) &&
              is_ok(local.add_node(NodeKind::kSubmap, T_a_loop, &local_loop));
  for (int32_t k = 0; fits && k < loop.count; ++k) {
    const SubmapView& view = submaps_.view(loop, k);
    if (!takes_part(k)) continue;
    const int32_t place = k < split ? local_a : local_b;
    const Sim3 X = T_node_kf(k);
    int32_t edge = -1;
    if (config_.factor(FactorKind::kBridge).enabled) {
      fits = is_ok(
          local.add_rigid_bridge(local_loop, place, view_measurement(view), X, bridge, &edge));
    }
    if (fits && config_.factor(FactorKind::kScaleAnchor).enabled) {
      fits = is_ok(
          local.add_scale_anchor(local_loop, place, view.log_rho - math::log(X.s), anchor, &edge));
    }
  }
  return fits && condenser_.condense(local_a, local_b, link);
}

}  // namespace unisim
