// SPDX-License-Identifier: MIT
// Loops that do not agree with the map: suspended, tried again, taken back.
#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"
#include "core/session.hpp"

namespace unisim {
namespace {

// A loop that closes a long drift needs a few optimisations until the map agrees with it.
constexpr int32_t kStrikes = 5;
constexpr int32_t kFirstWait = 10;  // optimisations
constexpr int32_t kLongestWait = 640;

}  // namespace

/// After an optimisation: who agrees with the map, who does not.
void Session::judge_loops() {
  for (const int32_t id : live_loops_) {
    Submap& loop = submaps_[id];
    if (loop.removed) continue;
    if (loop.health.suspended && counts_.optimizations < loop.health.retry_at) continue;
    if (loop.health.suspended) place_again(&loop);
    judge(&loop.health, id, loop_norm(loop));
    suspend_edges(loop, loop.health.suspended);
  }
  for (LoopEdge& loop : loop_edges_) {
    if (loop.edge < 0) continue;
    judge(&loop.health, loop.loop, graph_.edge_norm(loop.edge));
    suspend_edge(loop.edge, loop.health.suspended);
  }
}

/// The trial of a suspended loop is its residual on the map as it is. To let it pull again and see
/// would say nothing: a robust kernel has next to no pull on a loop that is far off.
void Session::judge(LoopHealth* health, int32_t loop, double norm) {
  const bool agrees = norm <= config_.loop_gate;
  const bool was_suspended = health->suspended;
  if (was_suspended && counts_.optimizations < health->retry_at) return;
  health->norm = norm;
  LogLine line;
  line << "loop " << loop;
  if (was_suspended && agrees) {
    *health = LoopHealth();
    health->norm = norm;
    --counts_.suspended_loops;
    ++counts_.loop_returns;
    line << " is back: residual " << norm << " within " << config_.loop_gate;
    line.send(config_.log, LogLevel::kInfo);
    return;
  }
  health->strikes = agrees ? 0 : health->strikes + 1;
  if (health->strikes < kStrikes) return;
  health->wait = was_suspended ? std::min(2 * health->wait, kLongestWait) : kFirstWait;
  health->retry_at = counts_.optimizations + health->wait;
  if (was_suspended) return;
  health->suspended = true;
  ++counts_.suspended_loops;
  ++counts_.loop_suspensions;
  line << " suspended: residual " << norm << " beyond " << config_.loop_gate << " after "
       << kStrikes << " optimisations, tried again in " << health->wait;
  line.send(config_.log, LogLevel::kWarning);
}

/// A loop sits on one of its places and misses the other: median residual there.
double Session::loop_norm(const Submap& loop) const {
  const int32_t split = split_view(loop);
  double worst = 0.0;
  for (const int32_t half : {0, 1}) {
    double norms[kMaxViews];
    int32_t count = 0;
    for (int32_t k = half == 0 ? 0 : split; k < (half == 0 ? split : loop.count); ++k) {
      const int32_t bridge = submaps_.view(loop, k).bridge;
      if (bridge >= 0) norms[count++] = graph_.edge_norm(bridge);
    }
    if (count > 0) worst = std::max(worst, median({norms, count}));
  }
  return worst;
}

void Session::suspend_edges(const Submap& loop, bool suspended) {
  for (int32_t k = 0; k < loop.count; ++k) {
    suspend_edge(submaps_.view(loop, k).bridge, suspended);
    suspend_edge(submaps_.view(loop, k).anchor, suspended);
  }
}

void Session::suspend_edge(int32_t edge, bool suspended) {
  if (edge < 0 || graph_.edge(edge).suspended == suspended) return;
  holds(graph_.set_suspended(edge, suspended));
  skeleton_is_due_ = true;
}

/// While it was suspended the map went on: it sits on its origin again.
void Session::place_again(Submap* loop) {
  if (!keyframes_.has(loop->origin_keyframe)) return;
  const double unit = math::exp(-submaps_.view(*loop, loop->origin).log_rho);
  holds(graph_.set_pose(loop->node, keyframe_pose(loop->origin_keyframe) * Sim3::scaling(unit)));
}

Status Session::remove_loop(int32_t id) {
  if (submaps_.gone(id)) return Status::kRetired;
  if (!submaps_.has(id) || !submaps_[id].is_loop || submaps_[id].removed) {
    return Status::kInvalidArgument;
  }
  Submap& loop = submaps_[id];
  skeleton_is_due_ = true;
  LogLine line;
  line << "loop " << id << " removed by the host";
  line.send(config_.log, LogLevel::kInfo);
  if (loop.retired) {
    const int32_t place = loop.loop_edge;
    if (place >= 0) {
      counts_.loops_removed += loop_edges_[place].loops;
      for (int32_t k = 0; k < submaps_.size(); ++k) {
        if (submaps_.at(k).loop_edge == place) submaps_.at(k).removed = true;
      }
      holds(graph_.remove_edge(loop_edges_[place].edge));
      release_loop_edge(place, -1);
    }
    loop.removed = true;
    return broken_ ? Status::kInternal : Status::kOk;
  }
  ++counts_.loops_removed;
  if (loop.health.suspended) --counts_.suspended_loops;
  loop.health = LoopHealth();
  const auto drop = [&](int32_t* edge) {
    if (*edge >= 0) holds(graph_.remove_edge(*edge));
    *edge = -1;
  };
  for (int32_t k = 0; k < loop.count; ++k) {
    SubmapView& view = submaps_.view(loop, k);
    drop(&view.bridge);
    drop(&view.anchor);
    view.used = false;
  }
  loop.removed = true;
  return broken_ ? Status::kInternal : Status::kOk;
}

Status Session::loop_status(int32_t id, LoopStatus* status) const {
  if (submaps_.gone(id)) return Status::kRetired;
  if (!submaps_.has(id) || !submaps_[id].is_loop) return Status::kInvalidArgument;
  const Submap& loop = submaps_[id];
  *status = LoopStatus();
  status->condensed = loop.retired;
  const LoopHealth* health = loop.retired ? nullptr : &loop.health;
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
