// SPDX-License-Identifier: MIT
// Which predictions a session wants next.
#pragma once

#include <cstdint>

#include "core/base/status.hpp"
#include "core/map/keyframe_ring.hpp"
#include "core/map/submap_window.hpp"

namespace unisim {

/// Kinds of predictions, bits of UNISIM_REQUEST_*.
inline constexpr uint32_t kRequestPair = 1;
inline constexpr uint32_t kRequestWindow = 2;

/// A wanted prediction: keyframes first .. first + count - 1.
struct Request {
  uint32_t kind = 0;
  Window keyframes;
};

/// Pairs are wanted one after another, the one behind the last settled keyframe; windows as soon as
/// their keyframes are settled.
class RequestSchedule {
 public:
  /// @param unit_by_next the unit of a keyframe is that of the pair after it: a window waits for
  ///                     that pair
  RequestSchedule(const KeyframeRing& keyframes, const WindowSchedule& windows, bool unit_by_next)
      : keyframes_(keyframes),
        windows_(windows),
        closed_at_(keyframes.size()),
        unit_by_next_(unit_by_next) {}

  /// The older one of an open window and an open pair. @return kOk; kNotReady without one
  Status next(uint32_t kinds, Request* request) const;
  /// Is this request open?
  bool wants(const Request& request) const;

  /// Open window with these ends, else the oldest that holds both.
  /// @return kOk; kInvalidArgument when there is none; kNotReady when it may not be answered yet
  Status find_window(int32_t first, int32_t last, int32_t* index) const;
  /// The window is answered or rejected. @return its keyframes
  Window take_window(int32_t index);
  bool has_window_over(int32_t keyframe) const { return windows_.find(keyframe, keyframe) >= 0; }

  /// A keyframe has been appended. false: `skipped` will not be asked for, for want of room
  bool keyframe_added(Window* skipped) {
    return windows_.keyframe_added(keyframes_.size(), skipped);
  }
  /// No more keyframes for the window that is being filled. @return kOk; kNotReady when that makes
  ///         no window ready
  Status close_window();
  /// Give up the oldest open window that begins before a keyframe. false: there is none
  bool drop_before(int32_t keyframe, Window* dropped) {
    return windows_.drop_before(keyframe, dropped);
  }

  /// Save or load; the keyframes are there.
  void visit(Archive* archive) {
    archive->index(&closed_at_, 0, keyframes_.size());
    windows_.visit(archive, keyframes_.size());
  }

 private:
  int32_t settled_for_windows() const;

  const KeyframeRing& keyframes_;
  WindowSchedule windows_;
  int32_t closed_at_;  // keyframes there were at the last close_window()
  bool unit_by_next_;
};

}  // namespace unisim
