// SPDX-License-Identifier: MIT
// How a session is laid out where nobody says otherwise.
#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/pipeline/keyframe_selector.hpp"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// Submaps of the sliding window: with the usual overlap as many keyframes as the geometric
/// predictor holds (180), since what it measures better of a submap that has left is lost. With 2
/// redkitchen ends at 0.0079 m (frames 0-499), with 8 at 0.0074, with 24 at 0.0067, where the full
/// batch does. An update takes twice the time it takes with 2, the arena half as much again.
inline constexpr int32_t kSlidingSubmaps = 24;

/// Keyframes that neighbouring windows share. Those cut from running tracks cost little, and more
/// of them hold the map together better: ATE on 500 frames of redkitchen 0.0077 m with overlap 2,
/// 0.0069 with 8, 0.0068 with 12. Every window of a network is an inference over all its views.
inline int32_t usual_overlap(std::string_view predictor, int32_t window_size) {
  const bool tracks = predictor == "geometric" || predictor == "recorded";
  const int32_t usual = tracks ? 8 : 2;
  return usual < window_size / 2 ? usual : window_size / 2;
}

/// Capacity that suits a run. Full batch: the keyframes a sequence can have, never reached. Sliding
/// window: as many as it needs, and predictors speak of, however long the sequence.
/// @param session      window_submaps, window_size
/// @param frames       frames of the sequence, < 0: not known
/// @param when_unknown returned for a full batch then
/// @param places       keyframes that loops reach back to; 0: none are looked for by the pipeline
int32_t keyframe_capacity(const unisim_config& session, int64_t frames,
                          const KeyframeConfig& keyframes, int32_t when_unknown,
                          int32_t places = 0);

}  // namespace unisim::pipeline
