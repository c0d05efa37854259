// SPDX-License-Identifier: MIT
// Why a run stands where it stands.
#include "drivers/pipeline/tracking_reason.hpp"

#include "unisim/unisim.h"

namespace unisim::pipeline {

const char* reason_name(int32_t reason) {
  constexpr std::array<const char*, UNISIM_REASON_COUNT> kNames = {
      "",
      "covered",
      "exposure",
      "blur",
      "too little texture",
      "duplicates",
      "time gap",
      "no start yet",
      "prediction refused",
      "no start yet: not enough motion",
      "no start yet: only turned",
      "no start yet: too little parallax",
      "no start yet: features lost",
      "no start yet: no rigid scene",
      "turned on the spot"};
  if (reason < 0 || reason >= UNISIM_REASON_COUNT) return "";
  return kNames[static_cast<size_t>(reason)];
}

namespace {

/// A frame that came twice harms nothing, and what a start lacks harms no track: they explain no
/// loss.
bool explains_loss(int32_t reason) {
  return reason != UNISIM_REASON_NONE && reason != UNISIM_REASON_DUPLICATE &&
         reason < UNISIM_REASON_STILL;
}

}  // namespace

void TrackingReason::see_frame(int32_t reason) {
  newest_ = reason > 0 && reason < UNISIM_REASON_COUNT ? reason : UNISIM_REASON_NONE;
  ++frames_[static_cast<size_t>(newest_)];
  ++age_;
  if (!explains_loss(newest_)) return;
  cause_ = newest_;
  age_ = 0;
}

int32_t TrackingReason::of_state(int32_t state, bool scale_guessed) {
  if (state == UNISIM_STATE_DEGRADED && scale_guessed) return UNISIM_REASON_SPOT_TURN;
  if (state == UNISIM_STATE_DEGRADED || state == UNISIM_STATE_LOST)
    return cause_ != UNISIM_REASON_NONE ? cause_ : UNISIM_REASON_PREDICTION;
  if (age_ > kMemory) cause_ = UNISIM_REASON_NONE;
  if (state == UNISIM_STATE_INIT && newest_ == UNISIM_REASON_NONE) return UNISIM_REASON_START;
  return newest_;
}

}  // namespace unisim::pipeline
