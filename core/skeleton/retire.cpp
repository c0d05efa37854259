// SPDX-License-Identifier: MIT
// Windows that leave the sliding window: keyframes become rigid parts of their submap, what lies
// between two submaps becomes one chain edge.
#include <algorithm>
#include <cmath>

#include "core/map/view_edges.hpp"
#include "core/skeleton/skeleton.hpp"

namespace unisim {

Skeleton::Skeleton(Arena& arena, const SessionCapacity& capacity, Map& map, TieEdges& ties,
                   LoopWatch& watch)
    : map_(map),
      ties_(ties),
      watch_(watch),
      windows_(arena.begin_part("skeleton"), capacity.live_windows),
      loops_(arena, capacity.live_loops),
      nodes_(arena, capacity.skeleton > 0 ? capacity.skeleton + 1 : 0),
      loop_edges_(arena, capacity.loop_edges, map, watch),
      outbox_(arena, capacity.merges, map.config.first_keyframe_id),
      chains_(arena.begin_part("condenser"), capacity.condenser,
              capacity.live_windows > 0 ? capacity.graph.nodes : 0, map),
      order_(arena.take<int32_t>(capacity.live_windows > 0 ? capacity.graph.nodes : 0)),
      live_from_(map.config.first_keyframe_id) {}

void Skeleton::add_window(int32_t submap) {
  if (map_.broken()) return;
  put_in_order(submap);
  while (!map_.broken() && windows_.size() > map_.config.window_submaps) retire_oldest();
}

/// In time order, whatever the order in which they come.
void Skeleton::put_in_order(int32_t submap) {
  if (!windows_.push_back(submap)) map_.holds(Status::kInternal);
  for (int32_t k = windows_.size() - 1; k > 0; --k) {
    int32_t& older = windows_[k - 1];
    if (map_.submaps[older].window.first <= map_.submaps[windows_[k]].window.first) break;
    std::swap(older, windows_[k]);
  }
}

void Skeleton::retire_oldest() {
  const int32_t m = windows_[0];
  const int32_t n = windows_[1];
  ChainLink link;
  const bool linked = chains_.between_windows(map_.submaps[m], map_.submaps[n], &link);
  const int32_t node_m = map_.submaps[m].place.node;
  const int32_t node_n = map_.submaps[n].place.node;
  retire_submap(m, n, map_.submaps[n].window.first);
  if (linked && !map_.broken()) add_link(node_m, node_n, link);
  retire_loops();
  merge_surplus();
}

/// Nothing has come for a ring's length: no keyframe stays but the newest settled one.
void Skeleton::retire_last() {
  while (!map_.broken() && windows_.size() > 1) retire_oldest();
  if (map_.broken()) return;
  if (windows_.empty()) {
    map_.holds(Status::kInternal);
    return;
  }
  const int32_t last = windows_[0];
  retire_submap(last, last, map_.keyframes.settled());
  retire_loops();
  merge_surplus();
}

/// Window m, the oldest, becomes a node of the skeleton; keyframes before `end` hang on it or on n.
void Skeleton::retire_submap(int32_t m, int32_t n, int32_t end) {
  Submap& old = map_.submaps[m];
  for (int32_t k = 0; k < old.count; ++k) drop_view_edges(map_, &map_.submaps.view(old, k));
  ties_.drop(m);
  if (!map_.holds(map_.graph.set_kind(old.place.node, NodeKind::kSkeleton))) return;
  old.place.retired = true;
  map_.submaps.release_views(&old);
  for (int32_t k = 0; k + 1 < windows_.size(); ++k) windows_[k] = windows_[k + 1];
  windows_.pop_back();
  ++counts_.windows;
  if (!nodes_.push_back({m, 1, old.owned})) map_.holds(Status::kInternal);
  for (int32_t id = live_from(); id < end; ++id) retire_keyframe(id, m, n);
  live_from_ = std::max(live_from_, end);
}

/// A chain beyond the declared number of edges is left out: the gauge holds what it would have.
void Skeleton::add_link(int32_t a, int32_t b, const ChainLink& link) {
  const EdgeWeight weight = {1.0, 1.0, map_.config.kernel(EdgeOrigin::kWindow),
                             EdgeOrigin::kWindow};
  int32_t edge = -1;
  const Status status = map_.graph.add_chain(a, b, link, weight, &edge);
  if (status != Status::kCapacity) map_.holds(status);
}

void Skeleton::retire_keyframe(int32_t id, int32_t m, int32_t n) {
  Keyframe& keyframe = map_.keyframes[id];
  if (map_.broken() || keyframe.node < 0) return;
  const int32_t owner = owner_of(id, m, n);
  Submap& carrier = map_.submaps[owner];
  keyframe.T_owner_kf = between(map_.submap_pose(carrier), map_.graph.pose(keyframe.node));
  keyframe.owner = owner;
  map_.holds(map_.graph.remove_node(keyframe.node));
  keyframe.node = -1;
  note_owned(&carrier, id);
  ++counts_.keyframes;
  // Its edges to loops have gone with the node: from now on they end at its owner.
  for (const int32_t loop : loops_) {
    const Submap& submap = map_.submaps[loop];
    for (int32_t k = 0; k < submap.count; ++k) {
      SubmapView& view = map_.submaps.view(submap, k);
      if (view.keyframe == id && view.used) attach(submap, &view);
    }
  }
}

void Skeleton::note_owned(Submap* carrier, int32_t keyframe) {
  carrier->owned.include(keyframe);
  if (!carrier->place.retired) return;
  for (int32_t k = nodes_.size() - 1; k >= 0; --k) {
    if (map_.submaps[nodes_[k].submap].place.node != carrier->place.node) continue;
    nodes_[k].owned.include(keyframe);
    return;
  }
}

/// The window over it whose centre is nearest; without one the nearer of the two it lies between.
int32_t Skeleton::owner_of(int32_t id, int32_t m, int32_t n) const {
  const SubmapTable& submaps = map_.submaps;
  const int32_t best = map_.keyframes[id].best_submap;
  if (best >= 0 && submaps.has(best) && !submaps[best].is_loop) return best;
  const auto distance = [&](int32_t submap) {
    return std::abs(submaps.origin_keyframe(submaps[submap]) - id);
  };
  const int32_t segment = map_.keyframes[id].segment;
  const bool m_fits = submaps[m].segment == segment;
  const bool n_fits = submaps[n].segment == segment;
  if (m_fits != n_fits) return m_fits ? m : n;
  return distance(m) <= distance(n) ? m : n;
}

}  // namespace unisim
