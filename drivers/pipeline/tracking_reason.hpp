// SPDX-License-Identifier: MIT
// Why a run stands where it stands: what is wrong with the frames, kept as long as it tells on the
// state.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/predictor.h"

namespace unisim::pipeline {

/// One or a few words for a UNISIM_REASON_*; "" for none.
const char* reason_name(int32_t reason);

class TrackingReason {
 public:
  /// Frames after which a reason no longer explains a state that comes later: a second.
  static constexpr int kMemory = 30;

  /// What the predictor says of the next frame; what is no UNISIM_REASON_* counts as none.
  void see_frame(int32_t reason);

  /// UNISIM_REASON_* now. While tracking goes well that of the newest frame. Without a track the
  /// newest there was around its loss, else UNISIM_REASON_PREDICTION; before the start
  /// UNISIM_REASON_START.
  /// @param scale_guessed of the newest pair, which was taken: see UNISIM_REASON_SPOT_TURN
  int32_t of_state(int32_t state, bool scale_guessed = false);

  /// Frames with each reason.
  const std::array<int64_t, UNISIM_REASON_COUNT>& frames() const { return frames_; }

 private:
  int32_t newest_ = UNISIM_REASON_NONE;
  int32_t cause_ = UNISIM_REASON_NONE;
  int age_ = 0;  // of the cause, frames
  std::array<int64_t, UNISIM_REASON_COUNT> frames_{};
};

}  // namespace unisim::pipeline
