// SPDX-License-Identifier: MIT
// The past of a map: windows that have left the sliding window, and the loops over them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/fixed_vector.hpp"
#include "core/map/map.hpp"
#include "core/map/tie_edges.hpp"
#include "core/skeleton/chain_maker.hpp"
#include "core/skeleton/loop_edges.hpp"
#include "core/skeleton/loop_watch.hpp"
#include "core/skeleton/outbox.hpp"

namespace unisim {

/// A node of the skeleton.
struct SkeletonNode {
  int32_t submap = -1;  ///< window whose node it is
  int32_t windows = 0;  ///< that hang on it, itself included
  KeyframeRange owned;  ///< keyframes that hang on it lie in it
};

/// Numbers of UNISIM_LOOP_*.
enum class LoopState : int32_t { kActive = 0, kSuspended = 1, kRigid = 2, kRemoved = 3 };

/// How a loop stands.
struct LoopStatus {
  LoopState state = LoopState::kActive;
  bool condensed = false;  ///< its keyframes have left the window
  double norm = 0.0;       ///< whitened residual after the last optimisation
};

/// Counters.
struct SkeletonCounts {
  int32_t keyframes = 0;      ///< that have retired
  int32_t windows = 0;        ///< likewise
  int32_t loops = 0;          ///< likewise
  int32_t stretches = 0;      ///< of keyframes that no window came for
  int32_t loops_removed = 0;  ///< by the host
};

/// Lets windows retire one by one, oldest first, and keeps what is left of them bounded:
///
///     window with keyframes ──► node of the skeleton ──► rigid part of its neighbour ──► forgotten
///       (windows())  retire       (nodes())        merge                         forget
///     loop with views  ──► chain edge between two nodes (loop_edges())
///       (loops())
///
/// In the full batch it holds nothing but the loops.
class Skeleton {
 public:
  Skeleton(Arena& arena, const SessionCapacity& capacity, Map& map, TieEdges& ties,
           LoopWatch& watch);

  // ---- what comes (skeleton/retire.cpp)
  /// A window is in the graph with its edges; the oldest retire in its place.
  void add_window(int32_t submap);
  /// A loop is in the graph with its edges; make_room(true) has been called.
  void add_loop(int32_t submap);

  // ---- room (skeleton/make_room.cpp)
  /// Keyframes up to `oldest` are about to leave the ring: nothing may depend on them any more.
  void let_go_through(int32_t oldest);
  /// Keyframes that no window came for leave the sliding window all the same, under a submap that
  /// has nothing but their pairs. false: there are none
  bool close_stretch();
  /// Room for one more submap in the table.
  void make_room(bool is_loop);
  /// Loops tangle the graph beyond the solver's memory: a few give way. false: none is left
  bool untangle();

  // ---- loops (skeleton/retire_loop.cpp)
  /// Look at each, after optimisation number `now`.
  void watch_loops(int64_t now);
  /// @return kOk; kRetired; kInvalidArgument for what is no loop, or removed
  Status remove_loop(int32_t id);
  Status loop_status(int32_t id, LoopStatus* status) const;

  // ---- streaming out
  /// @return kOk; kNotReady when there is nothing new
  Status next_retired(Retired* retired) {
    return outbox_.next(map_.keyframes, live_from(), retired);
  }

  // ---- reading
  Span<const int32_t> windows() const { return windows_.span(); }
  Span<const int32_t> loops() const { return loops_.span(); }
  /// In time order.
  Span<const SkeletonNode> nodes() const { return nodes_.span(); }
  /// Older keyframes have retired or are forgotten.
  int32_t live_from() const { return std::max(live_from_, map_.keyframes.first()); }
  const SkeletonCounts& counts() const { return counts_; }
  const LoopEdges& loop_edges() const { return loop_edges_; }
  int32_t unread() const { return outbox_.unread(); }

  // ---- saving and loading (skeleton/skeleton_snapshot.cpp, skeleton/skeleton_check.cpp)
  /// All but edges; keyframes and submaps are there. To load, both are checked with it.
  void visit(Archive* archive);
  /// Edges of the map, those between windows that share keyframes included.
  void visit_edges(Archive* archive);

 private:
  // skeleton/retire.cpp
  void put_in_order(int32_t submap);
  void retire_oldest();
  void retire_last();
  void retire_submap(int32_t m, int32_t n, int32_t end);
  void add_link(int32_t a, int32_t b, const ChainLink& link);
  void retire_keyframe(int32_t id, int32_t m, int32_t n);
  void note_owned(Submap* carrier, int32_t keyframe);
  int32_t owner_of(int32_t id, int32_t m, int32_t n) const;

  // skeleton/retire_loop.cpp
  void retire_loops();
  void retire_loop(int32_t id);
  void condense_early(int32_t id);
  void add_loop_edge(int32_t a, int32_t b, const ChainLink& link, Submap* loop);
  bool all_retired(const Submap& loop) const;
  int32_t node_under(int32_t keyframe) const;
  int32_t main_node(const Submap& loop, int32_t begin, int32_t end) const;
  void attach(const Submap& loop, SubmapView* view);

  // skeleton/merge.cpp
  void merge_surplus();
  int32_t cheapest_merge() const;
  void merge(int32_t k);
  void erase(int32_t k);
  void hang_submaps(int32_t a, int32_t b, const Sim3& T_a_b);
  void merge_metric(int32_t a, int32_t b, const Sim3& T_a_b);
  void move_chains(int32_t a, int32_t b, const Sim3& T_a_b);
  void detach_loop_views(int32_t node);
  void attach_loop_views();

  // skeleton/skeleton_snapshot.cpp
  void find_live_submaps(Archive* archive);
  void visit_nodes(Archive* archive);
  void visit_view_edges(Archive* archive, const Submap& submap, SubmapView* view);

  // skeleton/skeleton_check.cpp
  bool is_carrier(int32_t node) const;
  bool is_skeleton(int32_t node) const;
  bool mark_carriers();
  bool holds_together() const;
  bool holds(const Submap& submap) const;
  bool window_holds(const Submap& window) const;
  bool loop_holds(const Submap& loop) const;
  bool retired_holds(const Submap& submap) const;
  bool holds(int32_t keyframe) const;
  bool ends_at(const SubmapView& view, int32_t node) const;
  bool chains_hold() const;

  // skeleton/make_room.cpp
  int32_t first_uncovered() const;
  void forget_window();
  void forget_loop();
  void forget_part();
  void drop_weakest_loop();

  Map& map_;
  TieEdges& ties_;
  LoopWatch& watch_;
  FixedVector<int32_t> windows_;  // that still have their keyframes, oldest first
  FixedVector<int32_t> loops_;    // that still have their views
  FixedVector<SkeletonNode> nodes_;
  LoopEdges loop_edges_;
  Outbox outbox_;
  ChainMaker chains_;
  Span<int32_t> order_;  // node -> position in time among skeleton and window
  int32_t live_from_;
  SkeletonCounts counts_;
};

}  // namespace unisim
