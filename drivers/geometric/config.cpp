// SPDX-License-Identifier: MIT
// Reads and checks the configuration a caller hands in.
#include "drivers/geometric/config.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

void unisim_geometric_config_init(unisim_geometric_config* config, size_t struct_size) {
  if (config == nullptr) return;
  unisim_geometric_config defaults{};
  defaults.struct_size = static_cast<uint32_t>(struct_size);
  defaults.max_tracks = 300;
  defaults.max_keyframes = 180;
  defaults.max_landmarks = 5000;
  defaults.max_window_views = 512;
  defaults.window_size = 16;
  defaults.adjust_every = 10;
  defaults.adjust_latency = 4;
  defaults.background = 1;
  defaults.revive_age = 100;
  defaults.revive_tries = 150;
  std::memcpy(config, &defaults, std::min(struct_size, sizeof(defaults)));
}

namespace unisim::geometric {

namespace {

struct Range {
  const char* name;
  int32_t value;
  int32_t least;
  int32_t most;
};

}  // namespace

std::string read_config(const unisim_geometric_config* in, unisim_geometric_config* out) {
  unisim_geometric_config_init(out, sizeof(*out));
  if (in == nullptr) return {};
  if (in->struct_size != sizeof(*out)) {
    return "geometric: struct_size of the configuration is " + std::to_string(in->struct_size) +
           ", expected " + std::to_string(sizeof(*out)) + "; call unisim_geometric_config_init()";
  }
  *out = *in;
  const Range ranges[] = {
      {"max_tracks", in->max_tracks, 50, 2000},
      {"max_keyframes", in->max_keyframes, 32, 4096},
      {"max_landmarks", in->max_landmarks, 4 * in->max_tracks, 1000000},
      {"max_window_views", in->max_window_views, UNISIM_MAX_VIEWS, 65536},
      {"window_size", in->window_size, 5, UNISIM_MAX_VIEWS},
      {"adjust_every", in->adjust_every, 0, 100000},
      {"adjust_latency", in->adjust_latency, 1, 1000},
      {"background", in->background, 0, 1},
      {"revive_age", in->revive_age, 0, 1000000},
      {"revive_tries", in->revive_tries, 0, in->max_tracks},
  };
  for (const Range& range : ranges) {
    if (range.value >= range.least && range.value <= range.most) continue;
    return std::string("geometric: ") + range.name + " is " + std::to_string(range.value) +
           ", must be " + std::to_string(range.least) + " to " + std::to_string(range.most);
  }
  if (!std::isfinite(in->focal_px) || in->focal_px < 0) {
    return "geometric: focal_px must be a positive number of pixels, or 0 to estimate it";
  }
  return {};
}

}  // namespace unisim::geometric
