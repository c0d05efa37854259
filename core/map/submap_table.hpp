// SPDX-License-Identifier: MIT
// The submaps of a session, with their views and the keyframes they share.
#pragma once

#include <cstdint>

#include "core/base/fixed_vector.hpp"
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

/// A window's or a loop's prediction in the graph.
struct Submap {
  int32_t node = -1;       ///< graph node; or that of the submap it hangs on
  Sim3 T_node_submap;      ///< pose under that node; identity where the node is the submap's own
  int32_t first_view = 0;  ///< in the table's view pool
  int32_t count = 0;       ///< views, the unused ones included
  int32_t origin = 0;      ///< view at the submap's origin
  bool is_loop = false;
  bool own_node = true;      ///< false: hangs on the node of another submap by T_node_submap
  bool retired = false;      ///< part of the skeleton: no edges of its own
  int32_t window_first = 0;  ///< of a window: first keyframe asked for
  int32_t first_owned = -1;  ///< retired keyframes that hang on it lie in first..last, -1: none
  int32_t last_owned = -1;
  double center_sigma = 0.0;  ///< as handed in, 0: not known
  double scatter = 0.0;       ///< median over measured views
  double multiplier = 1.0;    ///< of its edges
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

/// Submaps by id (order of arrival), views in one pool, shared keyframes in one list.
/// Submap::node is the only link to the graph: freeing nodes of retired submaps leaves ids alone.
class SubmapTable {
 public:
  SubmapTable() = default;
  SubmapTable(Arena& arena, int32_t submaps, int32_t views, int32_t shared)
      : submaps_(arena, submaps), views_(arena, views), shared_(arena, shared) {}

  int32_t size() const { return submaps_.size(); }
  bool has(int32_t id) const { return id >= 0 && id < size(); }
  Submap& operator[](int32_t id) { return submaps_[id]; }
  const Submap& operator[](int32_t id) const { return submaps_[id]; }

  SubmapView& view(const Submap& submap, int32_t k) { return views_[submap.first_view + k]; }
  const SubmapView& view(const Submap& submap, int32_t k) const {
    return views_[submap.first_view + k];
  }
  Span<SharedKeyframe> shared() { return shared_.span(); }
  [[nodiscard]] bool add_shared(const SharedKeyframe& shared) { return shared_.push_back(shared); }

  bool has_room(int32_t views) const {
    return !submaps_.full() && views_.size() + views <= views_.capacity();
  }
  /// Append a submap with `views` fresh views; caller has checked has_room(). @return its id
  int32_t append(int32_t views) {
    Submap submap;
    submap.first_view = views_.size();
    submap.count = views;
    views_.resize(views_.size() + views);
    for (int32_t k = 0; k < views; ++k) views_[submap.first_view + k] = SubmapView();
    static_cast<void>(submaps_.push_back(submap));
    return size() - 1;
  }
  /// Take back the submap appended last, which has no shared keyframes yet.
  void remove_last() {
    views_.resize(submaps_.back().first_view);
    submaps_.pop_back();
  }

 private:
  FixedVector<Submap> submaps_;
  FixedVector<SubmapView> views_;
  FixedVector<SharedKeyframe> shared_;
};

}  // namespace unisim
