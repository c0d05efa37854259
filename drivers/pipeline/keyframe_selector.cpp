// SPDX-License-Identifier: MIT
// Which frames become keyframes.
#include "drivers/pipeline/keyframe_selector.hpp"

namespace unisim::pipeline {

bool KeyframeSelector::choose(int64_t frame_index, const unisim_motion& motion) {
  bool chosen = false;
  if (last_index_ < 0) {
    chosen = config_.stride > 0 || motion.keyframe_advice >= 0;
    if (chosen) first_index_ = frame_index;
  } else if (config_.stride > 0) {
    // On the grid of the first frame: after an unreadable frame the next one stands in for it.
    const int64_t cell = (frame_index - first_index_) / config_.stride;
    chosen = cell > (last_index_ - first_index_) / config_.stride;
  } else {
    chosen = by_motion(frame_index - last_index_, motion);
  }
  if (chosen) last_index_ = frame_index;
  return chosen;
}

bool KeyframeSelector::by_motion(int64_t gap, const unisim_motion& motion) const {
  if (motion.keyframe_advice != 0) return motion.keyframe_advice > 0;
  if (gap < config_.min_gap) return false;
  if (gap >= config_.max_gap) return true;
  const bool moved = motion.flow >= config_.flow;
  const bool lost_sight = motion.tracked >= 0.0 && motion.tracked < config_.tracked;
  return moved || lost_sight;
}

}  // namespace unisim::pipeline
