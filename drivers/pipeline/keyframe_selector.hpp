// SPDX-License-Identifier: MIT
// Which frames become keyframes: every N-th, or as the camera moves.
#pragma once

#include <cstdint>

#include "drivers/predictor.h"

namespace unisim::pipeline {

struct KeyframeConfig {
  int32_t stride = 0;    ///< > 0: every stride-th frame, nothing else counts; 0: by motion
  double flow = 0.03;    ///< taken when the median displacement exceeds this share of the diagonal
  double tracked = 0.6;  ///< taken when fewer of the last keyframe's features are still seen
  int32_t min_gap = 2;   ///< frames between keyframes, at least
  int32_t max_gap = 15;  ///< frames between keyframes, at most
};

/// Decides frame by frame, from the motion alone: the same numbers give the same keyframes.
/// By motion, the first frame and those the predictor asks for are taken, those it refuses are not.
class KeyframeSelector {
 public:
  explicit KeyframeSelector(const KeyframeConfig& config) : config_(config) {}

  /// @param frame_index position in the sequence, ascending, gaps allowed
  /// @param motion      what the predictor saw; unmeasured parts (< 0) do not count
  bool choose(int64_t frame_index, const unisim_motion& motion);

 private:
  bool by_motion(int64_t gap, const unisim_motion& motion) const;

  KeyframeConfig config_;
  int64_t first_index_ = -1;
  int64_t last_index_ = -1;
};

}  // namespace unisim::pipeline
