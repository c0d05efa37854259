// SPDX-License-Identifier: MIT
// The submaps of a session, with their views and the keyframes they share.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/fixed_vector.hpp"
#include "core/graph/graph.hpp"
#include "core/lie/sim3.hpp"

namespace unisim {

/// One keyframe as one submap sees it.
struct SubmapView {
  Sim3 T_submap_kf;      ///< prediction, scale 1, origin view at identity
  double log_rho = 0.0;  ///< log median(depth in the submap / two-view depth)
  double log_c = 0.0;    ///< log median(depth in shared_submap / depth here)
  double scatter = 0.0;  ///< of the pixels behind log_rho
  int32_t keyframe = -1;
  int32_t segment = -1;        ///< of the keyframe when the submap came, -1: it had no pose
  int32_t shared_submap = -1;  ///< earlier submap this view is tied to, -1: none
  int32_t shared_view = -1;    ///< position in it
  int32_t bridge = -1;         ///< edges in the graph, -1: none
  int32_t anchor = -1;
  bool measured = false;  ///< log_rho compares with a two-view depth
  bool used = false;      ///< takes part in the graph
};

/// Whether a loop agrees with the map; kept while it pulls and while it is suspended.
struct LoopHealth {
  double norm = 0.0;       ///< whitened residual after the last optimisation
  int32_t strikes = 0;     ///< optimisations in a row that left it beyond the gate
  int64_t retry_at = 0;    ///< suspended: optimisation that tries it again
  int32_t wait = 0;        ///< suspended: optimisations between tries, doubled each time
  bool suspended = false;  ///< its edges contribute nothing
};

void visit_health(Archive* archive, LoopHealth* health);

/// Keyframes first .. last.
struct KeyframeRange {
  int32_t first = 0;
  int32_t last = -1;

  bool empty() const { return last < first; }
  /// Grow, if need be, so that it holds these too.
  void include(const KeyframeRange& other) {
    if (other.empty()) return;
    first = empty() ? other.first : std::min(first, other.first);
    last = std::max(last, other.last);
  }
  void include(int32_t keyframe) { include(KeyframeRange{keyframe, keyframe}); }
};

/// Where a submap is: at a node of the graph or rigidly under it.
struct SubmapPlace {
  Sim3 T_node_submap;    ///< pose under the node; identity where the node is the submap's own
  int32_t node = -1;     ///< of the graph
  bool own_node = true;  ///< false: the node is another submap's, this one hangs on it
  bool retired = false;  ///< part of the skeleton: no edges of its own
};

/// How far a prediction can be trusted.
struct SubmapQuality {
  double center_sigma = 0.0;  ///< as handed in, 0: not known
  double scatter = 0.0;       ///< of the depth ratios, median over measured views
  double multiplier = 1.0;    ///< of its edges
};

/// A window's or a loop's prediction in the graph.
struct Submap {
  int32_t id = -1;       ///< -1: free slot
  int32_t segment = -1;  ///< of its origin
  bool is_loop = false;
  bool removed = false;    ///< a loop the host took back, or that gave way at capacity
  int32_t loop_edge = -1;  ///< of a retired loop: its slot among the loop edges, -1: none

  int32_t count = 0;       ///< views, the unused ones included
  int32_t origin = 0;      ///< view at the submap's origin
  int32_t first_view = 0;  ///< in the table's view pool; -1: given back, its keyframe ids stay
  int32_t first_id = 0;    ///< in the table's pool of keyframe ids

  KeyframeRange window;  ///< of a window: keyframes asked for
  KeyframeRange owned;   ///< retired keyframes that hang on it lie in it
  SubmapPlace place;
  SubmapQuality quality;
  LoopHealth health;  ///< of a live loop
};

/// A keyframe that submaps m and n both see: one tie edge, and one scale edge per pair (m, n).
struct SharedKeyframe {
  int32_t m = -1;  ///< earlier submap
  int32_t n = -1;
  int32_t view_m = -1;
  int32_t view_n = -1;
  double log_c = 0.0;  ///< log median(depth in m / depth in n)
  int32_t tie = -1;    ///< edges, -1: none
  int32_t scale = -1;
};

/// Sizes of a SubmapTable.
struct SubmapTableSize {
  int32_t windows = 0;  ///< submaps of windows that are kept
  int32_t loops = 0;    ///< loop submaps that are kept
  int32_t live = 0;     ///< submaps that have views
  int32_t views = 0;    ///< of one submap
  int32_t shared = 0;
};

/// Submaps by id (order of arrival) with their views, and the keyframes they share. Ids grow for
/// ever; submaps that are no longer needed are erased to make room.
class SubmapTable {
 public:
  SubmapTable() = default;
  SubmapTable(Arena& arena, const SubmapTableSize& size, int32_t first_id = 0);

  /// Submaps that are kept, in order of arrival; `position` is below this.
  int32_t size() const { return order_.size(); }
  Submap& at(int32_t position) { return slots_[order_[position]]; }
  const Submap& at(int32_t position) const { return slots_[order_[position]]; }

  int32_t next_id() const { return next_id_; }
  bool has(int32_t id) const { return slot_of(id) >= 0; }
  /// Was there, and has been erased.
  bool gone(int32_t id) const { return id >= 0 && id < next_id_ && !has(id); }
  Submap& operator[](int32_t id) { return slots_[slot_of(id)]; }
  const Submap& operator[](int32_t id) const { return slots_[slot_of(id)]; }

  /// Views of a submap that has not given them back.
  SubmapView& view(const Submap& submap, int32_t k) { return views_[submap.first_view + k]; }
  const SubmapView& view(const Submap& submap, int32_t k) const {
    return views_[submap.first_view + k];
  }
  int32_t keyframe(const Submap& submap, int32_t k) const { return ids_[submap.first_id + k]; }
  int32_t origin_keyframe(const Submap& submap) const { return keyframe(submap, submap.origin); }
  void set_keyframe(const Submap& submap, int32_t k, int32_t id) {
    ids_[submap.first_id + k] = id;
    views_[submap.first_view + k].keyframe = id;
  }

  Span<SharedKeyframe> shared() { return shared_.span(); }
  Span<const SharedKeyframe> shared() const { return shared_.span(); }
  [[nodiscard]] bool add_shared(const SharedKeyframe& shared) { return shared_.push_back(shared); }
  /// Forget what a submap shares.
  void drop_shared(int32_t id);

  bool has_room(bool is_loop) const {
    return (is_loop ? loops_ < most_loops_ : windows_ < most_windows_) && !free_views_.empty();
  }
  /// Append a submap with `views` fresh views; caller has checked has_room(). @return its id
  int32_t append(bool is_loop, int32_t views);
  /// Take back the submap appended last, which has no shared keyframes yet; its id is used again.
  void remove_last();
  /// Give its views back.
  void release_views(Submap* submap);
  void erase(int32_t id);

  // ---- saving and loading (submap_table_snapshot.cpp)
  /// Is there a window with this id, not retired, that has this view?
  bool has_view(int32_t id, int32_t k) const;
  /// Submaps, with the nodes that are their own; into a table that is empty.
  void visit(Archive* archive, Graph* graph);
  /// Edges between submaps; nodes are there.
  void visit_shared(Archive* archive, Graph* graph);

 private:
  int32_t slot_of(int32_t id) const;
  Submap& take_slot(bool is_loop);
  void take_views(Submap* submap);
  void visit_submap(Archive* archive, Graph* graph, Submap* submap);
  void visit_keyframes(Archive* archive, const Submap& submap);
  int32_t scale_of_pair(int32_t k) const;

  int32_t views_each_ = 0;
  int32_t most_windows_ = 0;
  int32_t most_loops_ = 0;
  Span<Submap> slots_;
  FixedVector<int32_t> order_;  // slots by id
  FixedVector<int32_t> free_slots_;
  Span<int32_t> ids_;  // keyframes, views_each_ for each slot
  Span<SubmapView> views_;
  FixedVector<int32_t> free_views_;  // first views of what is free
  FixedVector<SharedKeyframe> shared_;
  int32_t next_id_ = 0;
  int32_t windows_ = 0;
  int32_t loops_ = 0;
};

}  // namespace unisim
