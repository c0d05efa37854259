// SPDX-License-Identifier: MIT
// A sliding window never fills: what makes room for what comes.
#include <algorithm>

#include "core/session.hpp"

namespace unisim {

/// The ring is about to let go of its oldest keyframe: nothing may depend on it any more.
void Session::make_keyframe_room() {
  if (!keyframes_.full()) return;
  const int32_t oldest = keyframes_.first();
  while (settled_ <= oldest) refuse_pair(settled_ + 1, RefusalReason::kLate);
  // A part of the map that is forgotten takes its keyframes along.
  while (!broken_ && keyframes_.has(oldest) && keyframes_[oldest].node >= 0) {
    if (!close_stretch()) retire_last();
  }
  if (offered_ <= oldest) {
    const bool kept = keyframes_.has(oldest);
    if (kept && keyframes_.pose_source(oldest) >= 0) ++counts_.retired_unread;
    offered_ = oldest + 1;
  }
}

void Session::make_node_room() {
  if (!slides()) return;
  while (!broken_ && counts_.live_nodes > live_nodes_capacity_ && close_stretch()) {
  }
}

/// First keyframe behind all windows that are in the graph.
int32_t Session::first_uncovered() const {
  int32_t first = live_from_;
  for (const int32_t id : live_windows_) {
    first = std::max(first, submaps_[id].window_last + 1);
  }
  return first;
}

/// Keyframes that no window came for leave the window all the same, under a submap that has nothing
/// but their pairs. false: there are none.
bool Session::close_stretch() {
  int32_t posed[kMaxViews];
  int32_t count = 0;
  int32_t segment = -1;
  for (int32_t id = first_uncovered(); id <= settled_ && count < config_.window_size; ++id) {
    const Keyframe& keyframe = keyframes_[id];
    if (keyframe.node < 0) continue;
    if (count > 0 && keyframe.segment != segment) break;
    segment = keyframe.segment;
    posed[count++] = id;
  }
  if (count == 0) return false;
  LogLine line;
  line << "keyframes " << posed[0] << ".." << posed[count - 1]
       << " closed by their pairs: no window came";
  line.send(config_.log, LogLevel::kInfo);

  make_submap_room(false);
  const int32_t made = submaps_.append(false, 1);
  Submap& submap = submaps_[made];
  submap.window_first = posed[0];
  submap.window_last = posed[count - 1];
  submap.origin_keyframe = posed[count / 2];
  submap.segment = segment;
  submaps_.set_keyframe(submap, 0, submap.origin_keyframe);
  SubmapView& view = submaps_.view(submap, 0);
  view.segment = segment;
  view.used = true;
  const Sim3 T_world_origin = keyframe_pose(submap.origin_keyframe);
  if (!holds(graph_.add_node(NodeKind::kSubmap, T_world_origin, &submap.node))) return false;
  attach_view(submap, &view);
  ++counts_.stretches;
  retire_surplus(made);
  return !broken_;
}

void Session::make_submap_room(bool is_loop) {
  if (is_loop && live_loops_.full()) {
    LogLine line;
    line << "loop " << live_loops_[0] << " condensed early: too many loops at a time";
    line.send(config_.log, LogLevel::kInfo);
    condense_early(live_loops_[0]);
  }
  while (!broken_ && !submaps_.has_room(is_loop)) {
    if (is_loop) {
      forget_loop();
    } else {
      forget_window();
    }
  }
}

/// The oldest retired window that no skeleton node is known by, and the keyframes it carries.
void Session::forget_window() {
  for (int32_t k = 0; k < submaps_.size(); ++k) {
    const Submap& submap = submaps_.at(k);
    if (submap.is_loop || !submap.retired || submap.own_node) continue;
    const int32_t last = submap.last_owned;
    for (int32_t id = std::max(offered_, keyframes_.first()); id <= last; ++id) {
      ++counts_.retired_unread;
      offered_ = id + 1;
    }
    keyframes_.forget_before(last + 1);
    submaps_.erase(submap.id);
    return;
  }
  holds(Status::kInternal);
}

/// The oldest retired loop; what it measured stays in its edge.
void Session::forget_loop() {
  for (int32_t k = 0; k < submaps_.size(); ++k) {
    const Submap& submap = submaps_.at(k);
    if (!submap.is_loop || !submap.retired) continue;
    submaps_.erase(submap.id);
    return;
  }
  condense_early(live_loops_[0]);
}

/// A skeleton full of parts that nothing joins: the oldest is forgotten, with its keyframes.
void Session::forget_part() {
  const SkeletonNode oldest = skeleton_[0];
  const int32_t node = submaps_[oldest.submap].node;
  LogLine line;
  line << "oldest part of the map forgotten: keyframes up to " << oldest.last_owned
       << ", not joined to what came later";
  line.send(config_.log, LogLevel::kWarning);
  keyframes_.forget_before(oldest.last_owned + 1);
  detach_loop_views(node);
  for (int32_t place = 0; place < loop_edges_.size(); ++place) {
    const int32_t id = loop_edges_[place].edge;
    if (id < 0) continue;
    if (graph_.edge(id).a == node || graph_.edge(id).b == node) drop_loop_edge(place);
  }
  for (int32_t k = submaps_.size() - 1; k >= 0; --k) {
    if (submaps_.at(k).node == node) submaps_.erase(submaps_.at(k).id);
  }
  holds(graph_.remove_node(node));
  attach_loop_views();
  erase_skeleton(0);
}

}  // namespace unisim
