// SPDX-License-Identifier: MIT
// Which keyframe goes when the map is full.
#include "drivers/geometric/map/least_needed.hpp"

#include <algorithm>

namespace unisim::geometric {

namespace {

// Mean share lost beyond which thinning out would tear the map: four views of a landmark.
constexpr double kSparse = 1.0 / 3.0;

/// Mean of 1 / (views - 1) over the landmarks of a keyframe; 0: it has none.
double share_lost(const LandmarkMap& map, int32_t id) {
  double lost = 0;
  int landmarks = 0;
  for (int32_t i = 0; i < map.keyframe(id).observations; ++i) {
    const int32_t slot = map.observation(id, i).landmark;
    if (slot < 0 || map.landmark(slot).state != LandmarkState::kPlaced) continue;
    lost += 1.0 / std::max(map.landmark(slot).observations - 1, 1);
    ++landmarks;
  }
  return landmarks > 0 ? lost / landmarks : 0;
}

}  // namespace

int32_t least_needed_keyframe(const LandmarkMap& map) {
  const std::vector<int32_t>& ids = map.ids();
  const size_t older = ids.size() / 2;
  int32_t chosen = ids.front();
  double least = kSparse;
  for (size_t k = 0; k < older; ++k) {
    if (!map.keyframe(ids[k]).posed) return ids[k];
    const double lost = share_lost(map, ids[k]);
    if (lost >= least) continue;
    least = lost;
    chosen = ids[k];
  }
  return chosen;
}

}  // namespace unisim::geometric
