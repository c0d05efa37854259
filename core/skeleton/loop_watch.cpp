// SPDX-License-Identifier: MIT
// Watches whether loops agree with the map.
#include "core/skeleton/loop_watch.hpp"

#include <algorithm>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"
#include "core/skeleton/loop_places.hpp"

namespace unisim {
namespace {

// A loop that closes a long drift needs a few optimisations until the map agrees with it.
constexpr int32_t kStrikes = 5;
// Optimisations between looks at a suspended loop: soon at first, since the map may have been wrong
// and not the loop; then ever more rarely, since most of them are false.
constexpr int32_t kFirstWait = 10;
constexpr int32_t kLongestWait = 640;

bool is_waiting(const LoopHealth& health, int64_t now) {
  return health.suspended && now < health.retry_at;
}

}  // namespace

void LoopWatch::look_at(Submap* loop, int64_t now) {
  if (loop->removed || is_waiting(loop->health, now)) return;
  if (loop->health.suspended) place_again(*loop);
  judge(&loop->health, loop->id, norm_of(*loop), now);
  suspend_edges(*loop, loop->health.suspended);
}

void LoopWatch::look_at(LoopEdge* loop, int64_t now) {
  if (loop->edge < 0) return;
  if (!is_waiting(loop->health, now)) {
    judge(&loop->health, loop->loop, norm_of(*loop), now);
    loop->looked_at = map_.graph.revision();
  }
  suspend_edge(loop->edge, loop->health.suspended);
}

/// A suspended loop is tried by its residual on the map as it is. To let it pull again and see
/// would say nothing: a robust kernel has next to no pull on a loop that is far off.
void LoopWatch::judge(LoopHealth* health, int32_t loop, double norm, int64_t now) {
  const bool agrees = norm <= map_.config.loop_gate;
  const bool was_suspended = health->suspended;
  health->norm = norm;
  LogLine line;
  line << "loop " << loop;
  if (was_suspended && agrees) {
    come_back(health, &line);
    return;
  }
  health->strikes = agrees ? 0 : health->strikes + 1;
  if (health->strikes < kStrikes) return;
  health->wait = was_suspended ? std::min(2 * health->wait, kLongestWait) : kFirstWait;
  health->retry_at = now + health->wait;
  if (was_suspended) return;
  health->suspended = true;
  ++suspended_;
  ++suspensions_;
  line << " suspended: residual " << norm << " beyond " << map_.config.loop_gate << " after "
       << kStrikes << " optimisations, tried again in " << health->wait;
  line.send(map_.config.log, LogLevel::kWarning);
}

void LoopWatch::come_back(LoopHealth* health, LogLine* line) {
  const double norm = health->norm;
  *health = LoopHealth();
  health->norm = norm;
  --suspended_;
  ++returns_;
  *line << " is back: residual " << norm << " within " << map_.config.loop_gate;
  line->send(map_.config.log, LogLevel::kInfo);
}

/// A false loop sits well on one of its two places and misses the other: the median residual of the
/// place that it misses.
double LoopWatch::norm_of(const Submap& loop) const {
  const int32_t split = second_place(map_, loop);
  double worst = 0.0;
  for (const KeyframeRange& views : {KeyframeRange{0, split - 1}, {split, loop.count - 1}}) {
    double norms[kMaxViews];
    int32_t count = 0;
    for (int32_t k = views.first; k <= views.last; ++k) {
      const int32_t bridge = map_.submaps.view(loop, k).bridge;
      if (bridge >= 0) norms[count++] = map_.graph.edge_norm(bridge);
    }
    if (count > 0) worst = std::max(worst, median({norms, count}));
  }
  return worst;
}

/// The skeleton is held most of the time: an edge between nodes that stay is as it was.
double LoopWatch::norm_of(const LoopEdge& loop) const {
  const bool same = !map_.graph.edge_changed_since(loop.edge, loop.looked_at);
  return same ? loop.health.norm : map_.graph.edge_norm(loop.edge);
}

void LoopWatch::suspend_edges(const Submap& loop, bool suspended) {
  for (int32_t k = 0; k < loop.count; ++k) {
    suspend_edge(map_.submaps.view(loop, k).bridge, suspended);
    suspend_edge(map_.submaps.view(loop, k).anchor, suspended);
  }
}

void LoopWatch::suspend_edge(int32_t edge, bool suspended) {
  if (edge < 0 || map_.graph.edge(edge).suspended == suspended) return;
  map_.holds(map_.graph.set_suspended(edge, suspended));
  note_news();
}

/// The map has gone on while the loop was suspended: put it on its origin keyframe again, so that
/// its residual says how far it is from the map of now.
void LoopWatch::place_again(const Submap& loop) {
  const int32_t origin = map_.submaps.origin_keyframe(loop);
  if (!map_.keyframes.has(origin)) return;
  const double unit = math::exp(-map_.submaps.view(loop, loop.origin).log_rho);
  map_.holds(
      map_.graph.set_pose(loop.place.node, map_.keyframe_pose(origin) * Sim3::scaling(unit)));
}

}  // namespace unisim
