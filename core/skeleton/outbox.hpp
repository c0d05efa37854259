// SPDX-License-Identifier: MIT
// What leaves the window is offered once, in order, to whoever keeps it.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/status.hpp"
#include "core/map/keyframe_ring.hpp"

namespace unisim {

/// What has left the window, as it is offered once.
struct Retired {
  int32_t keyframe = -1;  ///< -1: a submap that has become rigid
  int64_t timestamp_ns = 0;
  int32_t submap = -1;  ///< the keyframe's owner, or the submap that has become rigid
  int32_t anchor = -1;  ///< of a submap: the one it hangs on from now on
  Sim3 T;               ///< T_submap_kf or T_anchor_submap, scale included
  int32_t confidence = 0;
  int32_t segment = -1;
};

/// Offers retired keyframes out of their ring, then merges of the skeleton out of a ring of its
/// own. What is not fetched in time is lost and counted.
class Outbox {
 public:
  /// @param merges that wait at a time
  Outbox(Arena& arena, int32_t merges, int32_t first_keyframe)
      : merges_(arena.take<Retired>(merges)), offered_(first_keyframe) {}

  void add_merge(const Retired& merge) { merges_[made_++ % merges_.size()] = merge; }
  /// Keyframes up to this one are about to be forgotten.
  void lose_through(const KeyframeRing& keyframes, int32_t last);

  /// @param end keyframes from this one on have not retired
  /// @return kOk; kNotReady when there is nothing new
  Status next(const KeyframeRing& keyframes, int32_t end, Retired* retired);

  int32_t unread() const { return unread_; }  ///< lost so far

  /// Save or load; the keyframes and submaps are there.
  void visit(Archive* archive, const KeyframeRing& keyframes, int32_t next_submap);

 private:
  static void visit_merge(Archive* archive, int32_t next_submap, Retired* merge);

  Span<Retired> merges_;
  int32_t offered_;  // older keyframes have been offered or lost
  int32_t made_ = 0;
  int32_t read_ = 0;
  int32_t unread_ = 0;
};

}  // namespace unisim
