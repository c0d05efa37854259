// SPDX-License-Identifier: MIT
// Watches whether loops agree with the map.
#pragma once

#include <cstdint>

#include "core/base/counter.hpp"
#include "core/map/map.hpp"
#include "core/skeleton/loop_edge.hpp"

namespace unisim {

/// A false loop must not bend the map. After each optimisation every loop's residual is compared
/// with the gate of the configuration:
///
///     pulls ──► five times in a row beyond the gate ──► suspended: its edges contribute nothing
///       ▲                                                   │ 10, 20, ... 640 optimisations later
///       └────────── within the gate ◄── looked at again ◄───┘ beyond it: twice the wait
class LoopWatch {
 public:
  explicit LoopWatch(Map& map) : map_(map) {}

  /// After optimisation number `now`, for a loop that still has its views.
  void look_at(Submap* loop, int64_t now);
  /// The same for a condensed one.
  void look_at(LoopEdge* loop, int64_t now);

  /// Let the edges of a loop pull no more, or again.
  void suspend_edges(const Submap& loop, bool suspended);
  void suspend_edge(int32_t edge, bool suspended);

  /// A loop with this health has come under watch, or leaves it.
  void take(const LoopHealth& health) { suspended_ += health.suspended ? 1 : 0; }
  void leave(const LoopHealth& health) { suspended_ -= health.suspended ? 1 : 0; }

  int32_t suspended() const { return suspended_; }      ///< now
  int32_t suspensions() const { return suspensions_; }  ///< so far
  int32_t returns() const { return returns_; }          ///< suspended ones that agreed again

  /// Has a loop come, gone or changed since news_solved()? Only loops tie the skeleton together.
  bool has_news() const { return news_; }
  void note_news() { news_ = true; }
  void news_solved() { news_ = false; }

  /// Save or load; what is under watch has to be taken again.
  void visit(Archive* archive) {
    suspensions_.visit(archive);
    returns_.visit(archive);
    archive->flag(&news_);
  }

 private:
  void judge(LoopHealth* health, int32_t loop, double norm, int64_t now);
  void come_back(LoopHealth* health, LogLine* line);
  double norm_of(const Submap& loop) const;
  double norm_of(const LoopEdge& loop) const;
  void place_again(const Submap& loop);

  Map& map_;
  int32_t suspended_ = 0;
  Counter suspensions_;
  Counter returns_;
  bool news_ = true;
};

}  // namespace unisim
