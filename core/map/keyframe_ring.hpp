// SPDX-License-Identifier: MIT
// The keyframes of a session, in order of arrival.
#pragma once

#include <cstdint>

#include "core/base/fixed_vector.hpp"
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
  int32_t best_submap = -1;          ///< covering submap whose centre is nearest in views
  int32_t best_distance = 0;         ///< that distance
  int32_t window_count = 0;          ///< submaps of windows that cover it
  int32_t loop_count = 0;            ///< loop submaps that cover it

  bool retired() const { return owner >= 0; }
  bool posed() const { return node >= 0 || retired(); }
};

/// Keyframe by id. The full batch keeps all of them, so an id is an index; when old keyframes
/// retire into the skeleton an id becomes a position in a ring and only this class has to know.
class KeyframeRing {
 public:
  KeyframeRing() = default;
  KeyframeRing(Arena& arena, int32_t capacity) : keyframes_(arena, capacity) {}

  bool full() const { return keyframes_.full(); }
  int32_t size() const { return keyframes_.size(); }
  bool has(int32_t id) const { return id >= 0 && id < size(); }
  Keyframe& operator[](int32_t id) { return keyframes_[id]; }
  const Keyframe& operator[](int32_t id) const { return keyframes_[id]; }

  /// Caller has checked full(). @return its id
  int32_t append(int64_t timestamp_ns) {
    Keyframe keyframe;
    keyframe.timestamp_ns = timestamp_ns;
    static_cast<void>(keyframes_.push_back(keyframe));
    return size() - 1;
  }

  /// Keyframe that has the pose of `id`: itself, the one it is held from, or -1.
  int32_t pose_source(int32_t id) const {
    return keyframes_[id].posed() ? id : keyframes_[id].held_from;
  }

 private:
  FixedVector<Keyframe> keyframes_;
};

}  // namespace unisim
