// SPDX-License-Identifier: MIT
// Makes two segments of the map one.
#include "drivers/geometric/map/join_segments.hpp"

namespace unisim::geometric {

void join_segments(State* state, int32_t from, int32_t into, const WorldMove& move) {
  LandmarkMap& map = state->map;
  for (const int32_t k : map.ids()) {
    Keyframe& keyframe = map.keyframe(k);
    if (keyframe.segment != from) continue;
    keyframe.segment = into;
    if (keyframe.posed) keyframe.pose = move.apply(keyframe.pose);
  }
  for (int32_t slot = 0; slot < map.landmark_capacity(); ++slot) {
    Landmark& mark = map.landmark(slot);
    if (mark.state == LandmarkState::kFree || mark.segment != from) continue;
    mark.segment = into;
    if (mark.state == LandmarkState::kPlaced) mark.position = move.apply(mark.position);
  }
  if (state->segment == from) state->median_depth *= move.scale;
  state->enter(into);
}

}  // namespace unisim::geometric
