// SPDX-License-Identifier: MIT
// How much the parts of the mapper hold.
#include "drivers/geometric/map/capacities.hpp"

#include <algorithm>

namespace unisim::geometric {

int32_t observations_per_keyframe(const unisim_geometric_config& config) {
  return config.max_tracks + config.revive_tries;
}

MapCapacity map_capacity(const unisim_geometric_config& config) {
  return {config.max_keyframes, config.max_landmarks, observations_per_keyframe(config)};
}

BundleCapacity window_capacity(const unisim_geometric_config& config) {
  BundleCapacity out;
  out.cameras = config.max_keyframes;
  out.free_cameras =
      std::max({config.window_size, static_cast<int>(kMaxEarlyWindow), UNISIM_MAX_VIEWS});
  out.points = std::min(config.max_landmarks, out.free_cameras * config.max_tracks);
  out.observations = 2 * out.free_cameras * config.max_tracks;
  return out;
}

BundleCapacity whole_capacity(const unisim_geometric_config& config) {
  BundleCapacity out;
  out.cameras = out.free_cameras = config.max_keyframes;
  out.points = config.max_landmarks;
  out.observations = config.max_keyframes * config.max_tracks;
  return out;
}

}  // namespace unisim::geometric
