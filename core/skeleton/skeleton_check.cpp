// SPDX-License-Identifier: MIT
// Whether what has been loaded is a map: all that the rest of the code takes for granted.
#include <algorithm>

#include "core/skeleton/skeleton.hpp"

namespace unisim {
namespace {

bool holds_all(const KeyframeRange& outer, const KeyframeRange& inner) {
  return inner.empty() || (outer.first <= inner.first && inner.last <= outer.last);
}

}  // namespace

/// A node that others may hang on: of the skeleton or of a window that has its keyframes.
bool Skeleton::is_carrier(int32_t node) const {
  return node >= 0 && node < order_.size() && map_.graph.has_node(node) && order_[node] >= 0;
}

bool Skeleton::is_skeleton(int32_t node) const {
  return is_carrier(node) && order_[node] < nodes_.size();
}

/// Their position in time, by node. false: the list of skeleton nodes is not that of the submaps
/// that are such nodes.
bool Skeleton::mark_carriers() {
  order_.fill(-1);
  for (int32_t k = 0; k < nodes_.size(); ++k) {
    if (!map_.submaps.has(nodes_[k].submap)) return false;
    const Submap& submap = map_.submaps[nodes_[k].submap];
    if (submap.is_loop || !submap.place.retired || !submap.place.own_node) return false;
    if (order_[submap.place.node] >= 0) return false;
    order_[submap.place.node] = k;
  }
  for (int32_t k = 0; k < windows_.size(); ++k) {
    order_[map_.submaps[windows_[k]].place.node] = nodes_.size() + k;
  }
  int32_t skeleton = 0;
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    skeleton += submap.place.retired && submap.place.own_node ? 1 : 0;
  }
  return skeleton == nodes_.size();
}

bool Skeleton::holds_together() const {
  const KeyframeRing& keyframes = map_.keyframes;
  if (live_from_ > std::max(keyframes.first(), keyframes.settled())) return false;
  if (!map_.config.slides() && live_from_ > keyframes.first()) return false;
  for (const SkeletonNode& node : nodes_) {
    if (node.owned.first < 0 || node.owned.last >= live_from()) return false;
  }
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    if (!holds(map_.submaps.at(k))) return false;
  }
  for (int32_t id = keyframes.first(); id < keyframes.size(); ++id) {
    if (!holds(id)) return false;
  }
  return true;
}

bool Skeleton::holds(const Submap& submap) const {
  if (map_.submaps.keyframe(submap, submap.count - 1) >= map_.keyframes.size()) return false;
  if (submap.owned.last >= live_from()) return false;
  if (submap.place.retired) return retired_holds(submap);
  if (submap.loop_edge >= 0) return false;
  return submap.is_loop ? loop_holds(submap) : window_holds(submap);
}

/// It has its keyframes, and all of them are in the graph.
bool Skeleton::window_holds(const Submap& window) const {
  const KeyframeRange& range = window.window;
  if (window.removed || range.empty() || range.last > map_.keyframes.settled()) return false;
  if (range.first < live_from() || !map_.submaps.view(window, window.origin).used) return false;
  for (int32_t k = 0; k < window.count; ++k) {
    const SubmapView& view = map_.submaps.view(window, k);
    if (view.keyframe < range.first || view.keyframe > range.last) return false;
    if (view.used && map_.keyframes[view.keyframe].node < 0) return false;
  }
  return true;
}

bool Skeleton::loop_holds(const Submap& loop) const {
  if (!loop.removed && !map_.submaps.view(loop, loop.origin).used) return false;
  for (int32_t k = 0; k < loop.count; ++k) {
    const SubmapView& view = map_.submaps.view(loop, k);
    if (!view.used || !map_.keyframes.has(view.keyframe)) continue;
    if (!map_.keyframes[view.keyframe].posed()) return false;
  }
  return true;
}

bool Skeleton::retired_holds(const Submap& submap) const {
  if (!is_carrier(submap.place.node)) return false;
  if (submap.is_loop) {
    const int32_t slot = submap.loop_edge;
    return slot < 0 || loop_edges_.in_use(slot);
  }
  if (submap.removed || submap.loop_edge >= 0 || !is_skeleton(submap.place.node)) return false;
  return holds_all(nodes_[order_[submap.place.node]].owned, submap.owned);
}

bool Skeleton::holds(int32_t id) const {
  const Keyframe& keyframe = map_.keyframes[id];
  if (keyframe.posed() && id > map_.keyframes.settled()) return false;
  if (id < live_from() ? keyframe.node >= 0 : keyframe.retired()) return false;
  if (map_.keyframes.has(keyframe.held_from) && !map_.keyframes[keyframe.held_from].posed()) {
    return false;
  }
  if (!keyframe.retired()) return true;
  if (!map_.submaps.has(keyframe.owner)) return false;
  const Submap& owner = map_.submaps[keyframe.owner];
  return !owner.is_loop && owner.owned.first <= id && id <= owner.owned.last;
}

/// Where the edges of a view end: at its keyframe, or at what carries it.
bool Skeleton::ends_at(const SubmapView& view, int32_t node) const {
  if (!map_.keyframes.has(view.keyframe)) return is_carrier(node);
  const Keyframe& keyframe = map_.keyframes[view.keyframe];
  return node == (keyframe.retired() ? map_.submaps[keyframe.owner].place.node : keyframe.node);
}

/// Chains join carriers, and leave room for as many loops as there may be.
bool Skeleton::chains_hold() const {
  int32_t links = 0;
  for (int32_t id = 0; id < map_.graph.edge_end(); ++id) {
    const Edge& edge = map_.graph.edge(id);
    if (!edge.alive || edge.kind != FactorKind::kChain) continue;
    if (!is_carrier(edge.a) || !is_carrier(edge.b)) return false;
    links += edge.origin == EdgeOrigin::kWindow ? 1 : 0;
  }
  return links == 0 || links <= 2 * (nodes_.capacity() - 1 + windows_.capacity());
}

}  // namespace unisim
