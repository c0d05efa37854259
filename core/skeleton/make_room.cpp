// SPDX-License-Identifier: MIT
// A sliding window never fills: what makes room for what comes.
#include <algorithm>

#include "core/map/view_edges.hpp"
#include "core/skeleton/skeleton.hpp"

namespace unisim {

void Skeleton::let_go_through(int32_t oldest) {
  // A part of the map that is forgotten takes its keyframes along.
  while (!map_.broken() && map_.keyframes.has(oldest) && map_.keyframes[oldest].node >= 0) {
    if (!close_stretch()) retire_last();
  }
  outbox_.lose_through(map_.keyframes, oldest);
}

/// First keyframe behind all windows that are in the graph.
int32_t Skeleton::first_uncovered() const {
  int32_t first = live_from();
  for (const int32_t id : windows_) first = std::max(first, map_.submaps[id].window.last + 1);
  return first;
}

bool Skeleton::close_stretch() {
  int32_t posed[kMaxViews];
  int32_t count = 0;
  int32_t segment = -1;
  const int32_t settled = map_.keyframes.settled();
  for (int32_t id = first_uncovered(); id <= settled && count < map_.config.window_size; ++id) {
    const Keyframe& keyframe = map_.keyframes[id];
    if (keyframe.node < 0) continue;
    if (count > 0 && keyframe.segment != segment) break;
    segment = keyframe.segment;
    posed[count++] = id;
  }
  if (count == 0) return false;
  LogLine line;
  line << "keyframes " << posed[0] << ".." << posed[count - 1]
       << " closed by their pairs: no window came";
  line.send(map_.config.log, LogLevel::kInfo);

  make_room(false);
  const int32_t made = map_.submaps.append(false, 1);
  Submap& submap = map_.submaps[made];
  submap.window = {posed[0], posed[count - 1]};
  submap.segment = segment;
  const int32_t origin = posed[count / 2];
  map_.submaps.set_keyframe(submap, 0, origin);
  SubmapView& view = map_.submaps.view(submap, 0);
  view.segment = segment;
  view.used = true;
  if (!map_.holds(
          map_.graph.add_node(NodeKind::kSubmap, map_.keyframe_pose(origin), &submap.place.node))) {
    return false;
  }
  add_view_edges(map_, submap, &view);
  ++counts_.stretches;
  add_window(made);
  return !map_.broken();
}

void Skeleton::make_room(bool is_loop) {
  if (is_loop && loops_.full()) {
    LogLine line;
    line << "loop " << loops_[0] << " condensed early: too many loops at a time";
    line.send(map_.config.log, LogLevel::kInfo);
    condense_early(loops_[0]);
  }
  while (!map_.broken() && !map_.submaps.has_room(is_loop)) {
    if (is_loop) {
      forget_loop();
    } else {
      forget_window();
    }
  }
}

/// The oldest retired window that no skeleton node is known by, and the keyframes it carries.
void Skeleton::forget_window() {
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (submap.is_loop || !submap.place.retired || submap.place.own_node) continue;
    const int32_t last = submap.owned.last;
    outbox_.lose_through(map_.keyframes, last);
    map_.keyframes.forget_before(last + 1);
    map_.submaps.erase(submap.id);
    return;
  }
  map_.holds(Status::kInternal);
}

/// The oldest retired loop; what it measured stays in its edge.
void Skeleton::forget_loop() {
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (!submap.is_loop || !submap.place.retired) continue;
    map_.submaps.erase(submap.id);
    return;
  }
  condense_early(loops_[0]);
}

/// A skeleton full of parts that nothing joins: the oldest is forgotten, with its keyframes.
void Skeleton::forget_part() {
  const SkeletonNode oldest = nodes_[0];
  const int32_t node = map_.submaps[oldest.submap].place.node;
  LogLine line;
  line << "oldest part of the map forgotten: keyframes up to " << oldest.owned.last
       << ", not joined to what came later";
  line.send(map_.config.log, LogLevel::kWarning);
  map_.keyframes.forget_before(oldest.owned.last + 1);
  detach_loop_views(node);
  loop_edges_.drop_at(node);
  for (int32_t k = map_.submaps.size() - 1; k >= 0; --k) {
    if (map_.submaps.at(k).place.node == node) map_.submaps.erase(map_.submaps.at(k).id);
  }
  map_.metric.forget(node);
  map_.holds(map_.graph.remove_node(node));
  attach_loop_views();
  erase(0);
}

/// Drops a loop edge; there is one.
void Skeleton::drop_weakest_loop() {
  for (int32_t k = 0; k < nodes_.size(); ++k) {
    order_[map_.submaps[nodes_[k].submap].place.node] = k;
  }
  for (int32_t k = 0; k < windows_.size(); ++k) {
    order_[map_.submaps[windows_[k]].place.node] = nodes_.size() + k;
  }
  loop_edges_.drop(loop_edges_.weakest(order_));
}

bool Skeleton::untangle() {
  constexpr int32_t kAtATime = 8;
  bool dropped = false;
  for (int32_t k = 0; k < kAtATime && !loop_edges_.empty(); ++k) {
    drop_weakest_loop();
    dropped = true;
  }
  if (dropped) return true;
  if (!map_.config.slides() || loops_.empty()) return false;
  condense_early(loops_[0]);
  return !map_.broken();
}

}  // namespace unisim
