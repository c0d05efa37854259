// SPDX-License-Identifier: MIT
// Hands wide windows to the session and takes those back that a newer one says better.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/pipeline/session_client.hpp"
#include "drivers/predictor.h"

namespace unisim::pipeline {

/// A predictor that adjusts all it holds gives a wide window each time. Newer ones were measured on
/// the same images and more: one whose keyframes end before the middle of the newest stays, the
/// others leave. As long as nothing has left the sliding window, revisions say it all and none is
/// taken, but for those that join two segments, and what says that better later, and after a gap.
/// 100 keyframes of redkitchen (ATE), a sliding window of 2 submaps: 0.0097 m without wide windows,
/// 0.0082 m when every one stays, 0.0079 m so.
class WideWindows {
 public:
  explicit WideWindows(SessionClient* session);

  /// The track was lost and found again: windows of neighbours may all end at the gap.
  void note_gap() { gap_ = true; }

  /// One would be taken. Predictors are not asked before: a wide window costs them time.
  bool wanted() const;

  /// For wanted() windows. Views that the session no longer keeps are left out.
  /// @param[out] taken false: the session keeps too few of them, has no room for loops or
  ///             found the window too poor
  /// @return UNISIM_OK, or what ends the run
  unisim_status take(const unisim_window_prediction& predicted, bool* taken);

 private:
  struct Kept {
    int32_t submap_id;
    int32_t last_keyframe;
  };
  /// A window that holds two segments together.
  struct Join {
    int32_t submap_id;
    int32_t first;  // keyframes of the segment that was the younger one
    int32_t last;
  };
  bool revisions_say_all(const unisim_session_info& info) const;
  int32_t segment_of(int32_t keyframe_id) const;
  bool joins(const unisim_window_prediction& window, const unisim_session_info& info,
             Join* join) const;
  static bool covers(const unisim_window_prediction& window, const Join& join);
  unisim_status remove(int32_t submap_id);
  unisim_status drop_outdated(const unisim_window_prediction& newest);

  SessionClient* session_;
  std::vector<Kept> kept_;
  std::vector<Join> joins_;
  bool gap_ = false;
};

}  // namespace unisim::pipeline
