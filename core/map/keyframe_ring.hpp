// SPDX-License-Identifier: MIT
// The keyframes of a session, in order of arrival.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/span.hpp"
#include "core/graph/graph.hpp"
#include "core/lie/sim3.hpp"
#include "core/map/tracking_state.hpp"

namespace unisim {

/// What is kept of a keyframe; its pose is its graph node's, or once it has retired T_owner_kf
/// under its owner.
struct Keyframe {
  int64_t timestamp_ns = 0;
  int32_t node = -1;                 ///< graph node; -1: no prediction supports a pose
  int32_t owner = -1;                ///< retired: submap whose pose carries it, -1: none
  Sim3 T_owner_kf;                   ///< retired: pose in the owner, scale included
  int32_t held_from = -1;            ///< without a pose: keyframe whose pose stands in, -1: none
  int32_t segment = -1;              ///< -1 until it has a pose
  Tracking state = Tracking::kInit;  ///< after the pair that ends here was settled
  /// Of the scale that the pair ending here carried over. Not saved: windows of a later run lie
  /// over other pairs.
  double log_scale_sigma = 0.0;
  int32_t best_submap = -1;   ///< covering submap whose centre is nearest in views
  int32_t best_distance = 0;  ///< that distance
  int32_t window_count = 0;   ///< submaps of windows that cover it
  int32_t loop_count = 0;     ///< loop submaps that cover it

  bool retired() const { return owner >= 0; }
  bool posed() const { return node >= 0 || retired(); }
  /// 0 held or unknown, 1 pair only, 2 in a submap, 3 in two or a closed loop.
  int32_t confidence() const {
    if (!posed()) return 0;
    if (loop_count > 0 || window_count > 1) return 3;
    return window_count == 1 ? 2 : 1;
  }
};

/// Keyframe by id; ids grow (kLastId), the newest `capacity` keyframes are kept.
class KeyframeRing {
 public:
  KeyframeRing() = default;
  KeyframeRing(Arena& arena, int32_t capacity, int32_t first_id = 0)
      : keyframes_(arena.take<Keyframe>(capacity)),
        size_(first_id),
        first_(first_id),
        settled_(first_id) {}

  /// Would one more take the place of the oldest?
  bool full() const { return size_ - first_ == keyframes_.size(); }
  int32_t capacity() const { return keyframes_.size(); }
  /// The next id.
  int32_t size() const { return size_; }
  /// Oldest that is kept.
  int32_t first() const { return first_; }
  bool has(int32_t id) const { return id >= first_ && id < size_; }
  bool gone(int32_t id) const { return id >= 0 && id < first_; }
  Keyframe& operator[](int32_t id) { return keyframes_[place(id)]; }
  const Keyframe& operator[](int32_t id) const { return keyframes_[place(id)]; }

  /// When full() the oldest goes. @return its id
  int32_t append(int64_t timestamp_ns) {
    if (full()) ++first_;
    Keyframe keyframe;
    keyframe.timestamp_ns = timestamp_ns;
    keyframes_[size_ % keyframes_.size()] = keyframe;
    return size_++;
  }
  /// Let go of all keyframes before `id`.
  void forget_before(int32_t id) { first_ = std::max(first_, std::min(id, size_)); }

  /// Last keyframe whose pair with the one before is settled: taken or refused.
  int32_t settled() const { return settled_; }
  void settle(int32_t id) { settled_ = id; }

  /// Keyframe that has the pose of `id`: itself, the one it is held from, or -1.
  int32_t pose_source(int32_t id) const {
    const Keyframe& keyframe = (*this)[id];
    if (keyframe.posed()) return id;
    return has(keyframe.held_from) ? keyframe.held_from : -1;
  }

  /// Save or load, with the nodes (keyframe_ring_snapshot.cpp).
  void visit(Archive* archive, Graph* graph);

 private:
  int32_t place(int32_t id) const {
    UNISIM_CHECK(has(id));
    return id % keyframes_.size();
  }

  Span<Keyframe> keyframes_;
  int32_t size_ = 0;
  int32_t first_ = 0;
  int32_t settled_ = 0;
};

}  // namespace unisim
