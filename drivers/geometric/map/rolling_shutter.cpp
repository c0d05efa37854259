// SPDX-License-Identifier: MIT
// Rows of an image that are read one after the other.
#include "drivers/geometric/map/rolling_shutter.hpp"

namespace unisim::geometric {

namespace {
constexpr double kMostStep = 0.3;  // seconds between frames: beyond, motion is not steady
}  // namespace

cv::Point2f sway_of(const State& state, const cv::Point2f& at, const cv::Point2f& motion_px) {
  if (!state.intrinsics.rolling || !(state.frame_step_s > 0) || state.frame_step_s > kMostStep)
    return {};
  const double late = (at.y + 0.5) / state.size.height - 0.5;
  return motion_px * static_cast<float>(late / state.frame_step_s);
}

void see_motion_after(State* state) {
  const int32_t newest = state->map.end_id() - 1;
  if (!state->intrinsics.rolling || !state->map.holds(newest)) return;
  const Tracks& tracks = state->tracks;
  for (size_t i = 0; i < tracks.size(); ++i) {
    const Landmark& mark = state->map.landmark(tracks.landmark[i]);
    if (mark.last.keyframe != newest) continue;
    Observation& seen = state->map.observation(mark.last);
    const cv::Point2f after = sway_of(*state, {seen.x, seen.y}, tracks.velocity[i]);
    // What was found in the keyframe itself has no motion of its own before it.
    seen.sway = mark.observations > 1 ? 0.5F * (seen.sway + after) : after;
  }
}

}  // namespace unisim::geometric
