// SPDX-License-Identifier: MIT
// Loops of a map: watched, taken back, and once all their keyframes have retired condensed into one
// chain edge between two nodes.
#include <cmath>

#include "core/map/view_edges.hpp"
#include "core/skeleton/loop_places.hpp"
#include "core/skeleton/skeleton.hpp"

namespace unisim {

void Skeleton::add_loop(int32_t submap) {
  if (!loops_.push_back(submap)) map_.holds(Status::kInternal);
}

void Skeleton::watch_loops(int64_t now) {
  for (const int32_t id : loops_) watch_.look_at(&map_.submaps[id], now);
  for (LoopEdge& loop : loop_edges_.all()) watch_.look_at(&loop, now);
}

void Skeleton::retire_loops() {
  int32_t kept = 0;
  for (int32_t k = 0; k < loops_.size(); ++k) {
    const int32_t id = loops_[k];
    if (all_retired(map_.submaps[id])) {
      retire_loop(id);
    } else {
      loops_[kept++] = id;
    }
  }
  loops_.resize(kept);
}

bool Skeleton::all_retired(const Submap& loop) const {
  for (int32_t k = 0; k < loop.count; ++k) {
    const SubmapView& view = map_.submaps.view(loop, k);
    if (view.used && map_.keyframes.has(view.keyframe) && map_.keyframes[view.keyframe].node >= 0) {
      return false;
    }
  }
  return true;
}

/// Keyframes that have not retired are taken as rigid under the window they are nearest to.
void Skeleton::condense_early(int32_t id) {
  if (windows_.empty() && nodes_.empty()) close_stretch();
  int32_t kept = 0;
  for (const int32_t loop : loops_) {
    if (loop != id) loops_[kept++] = loop;
  }
  loops_.resize(kept);
  retire_loop(id);
}

/// Each of its two places becomes a node; the loop itself goes on as a rigid part of one of them.
void Skeleton::retire_loop(int32_t id) {
  if (map_.broken()) return;
  Submap& loop = map_.submaps[id];
  const int32_t split = second_place(map_, loop);
  const int32_t a = main_node(loop, 0, split);
  const int32_t b = main_node(loop, split, loop.count);
  ChainLink link;
  const bool linked = a >= 0 && b >= 0 && a != b && chains_.of_loop(loop, a, b, split, &link);
  const Sim3 T_world_loop = map_.graph.pose(loop.place.node);
  watch_.leave(loop.health);
  map_.holds(map_.graph.remove_node(loop.place.node));
  map_.submaps.release_views(&loop);
  ++counts_.loops;
  const int32_t either = a >= 0 ? a : b;
  const int32_t carrier = either >= 0 ? either : node_under(map_.submaps.origin_keyframe(loop));
  if (carrier < 0) {
    map_.submaps.erase(id);
    return;
  }
  loop.place.node = carrier;
  loop.place.T_node_submap = between(map_.graph.pose(carrier), T_world_loop);
  loop.place.own_node = false;
  loop.place.retired = true;
  if (linked && !loop.removed) add_loop_edge(a, b, link, &loop);
}

void Skeleton::add_loop_edge(int32_t a, int32_t b, const ChainLink& link, Submap* loop) {
  if (loop_edges_.join(a, b, link, loop)) return;
  if (loop_edges_.full()) drop_weakest_loop();
  loop_edges_.add(a, b, link, loop);
}

/// Node that carries a keyframe, or will: that of the window over it or nearest to it. -1: none.
int32_t Skeleton::node_under(int32_t keyframe) const {
  const SubmapTable& submaps = map_.submaps;
  if (!map_.keyframes.has(keyframe)) return -1;
  const Keyframe& asked = map_.keyframes[keyframe];
  if (asked.retired()) return submaps[asked.owner].place.node;
  int32_t best = asked.best_submap;
  if (best >= 0 && submaps.has(best) && !submaps[best].is_loop) return submaps[best].place.node;
  best = -1;
  const auto distance = [&](int32_t submap) {
    return std::abs(submaps.origin_keyframe(submaps[submap]) - keyframe);
  };
  for (const int32_t id : windows_) {
    if (submaps[id].segment != asked.segment) continue;
    if (best < 0 || distance(id) < distance(best)) best = id;
  }
  return best < 0 ? -1 : submaps[best].place.node;
}

/// A place of the loop may lie over two nodes, a chain edge ends at one: the node that carries the
/// most of the views begin .. end - 1, the first of those where that is equal. -1: none carries any
int32_t Skeleton::main_node(const Submap& loop, int32_t begin, int32_t end) const {
  const auto node_of = [&](int32_t k) {
    const SubmapView& view = map_.submaps.view(loop, k);
    return view.used ? node_under(view.keyframe) : -1;
  };
  int32_t best = -1;
  int32_t most = 0;
  for (int32_t k = begin; k < end; ++k) {
    const int32_t node = node_of(k);
    int32_t carried = 0;
    for (int32_t other = begin; other < end; ++other) carried += node_of(other) == node ? 1 : 0;
    if (node < 0 || carried <= most) continue;
    most = carried;
    best = node;
  }
  return best;
}

/// Edges of a live loop's view, suspended like its others.
void Skeleton::attach(const Submap& loop, SubmapView* view) {
  add_view_edges(map_, loop, view);
  if (loop.health.suspended) watch_.suspend_edges(loop, true);
}

Status Skeleton::remove_loop(int32_t id) {
  if (map_.submaps.gone(id)) return Status::kRetired;
  if (!map_.submaps.has(id) || !map_.submaps[id].is_loop || map_.submaps[id].removed) {
    return Status::kInvalidArgument;
  }
  Submap& loop = map_.submaps[id];
  watch_.note_news();
  LogLine line;
  line << "loop " << id << " removed by the host";
  line.send(map_.config.log, LogLevel::kInfo);
  if (loop.place.retired) {
    if (loop.loop_edge >= 0) counts_.loops_removed += loop_edges_.remove(loop.loop_edge);
  } else {
    ++counts_.loops_removed;
    watch_.leave(loop.health);
    loop.health = LoopHealth();
    for (int32_t k = 0; k < loop.count; ++k) {
      SubmapView& view = map_.submaps.view(loop, k);
      drop_view_edges(map_, &view);
      view.used = false;
    }
  }
  loop.removed = true;
  return map_.broken() ? Status::kInternal : Status::kOk;
}

Status Skeleton::loop_status(int32_t id, LoopStatus* status) const {
  const SubmapTable& submaps = map_.submaps;
  if (submaps.gone(id)) return Status::kRetired;
  if (!submaps.has(id) || !submaps[id].is_loop) return Status::kInvalidArgument;
  const Submap& loop = submaps[id];
  *status = LoopStatus();
  status->condensed = loop.place.retired;
  const LoopHealth* health = loop.place.retired ? nullptr : &loop.health;
  if (loop.loop_edge >= 0) health = &loop_edges_[loop.loop_edge].health;
  if (health != nullptr) status->norm = health->norm;
  if (loop.removed) {
    status->state = LoopState::kRemoved;
  } else if (health == nullptr) {
    status->state = LoopState::kRigid;
  } else if (health->suspended) {
    status->state = LoopState::kSuspended;
  }
  return Status::kOk;
}

}  // namespace unisim
