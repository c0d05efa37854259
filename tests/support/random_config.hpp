// SPDX-License-Identifier: MIT
// Configurations at random, and how many of them a test tries.
#pragma once

#include <cstdlib>
#include <random>

#include "tests/support/catch.hpp"
#include "unisim/unisim.h"

namespace unisim::test {

/// Seeds 1 .. this one; UNISIM_FUZZ_SEEDS asks for a longer run by hand. Seeds that find something
/// are kept in the range.
inline uint32_t fuzz_seeds() {
  constexpr uint32_t kSeeds = 60;
  const char* text = std::getenv("UNISIM_FUZZ_SEEDS");
  return text == nullptr ? kSeeds : static_cast<uint32_t>(std::strtoul(text, nullptr, 10));
}

inline unisim_config random_config(uint32_t seed) {
  std::mt19937 random(seed);
  unisim_config config;
  REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
  config.preset = random() % 4 == 0 ? UNISIM_PRESET_PAPER : UNISIM_PRESET_CONSISTENT;
  config.window_size = 2 + static_cast<int32_t>(random() % 15);
  config.window_overlap = static_cast<int32_t>(random()) % config.window_size;
  config.window_overlap = std::abs(config.window_overlap);
  config.max_keyframes = 2 + static_cast<int32_t>(random() % 150);
  config.max_loops = static_cast<int32_t>(random() % 6);
  config.max_submaps = random() % 3 == 0 ? 1 + static_cast<int32_t>(random() % 8) : 0;
  config.depth_grid_width = 4 + static_cast<int32_t>(random() % 30);
  config.depth_grid_height = 4 + static_cast<int32_t>(random() % 30);
  config.disabled_factors = random() % 3 == 0 ? random() % 32 : 0;
  config.lost_after = 1 + static_cast<int32_t>(random() % 4);
  config.skeleton_capacity = random() % 2 == 0 ? 8 : 0;
  if (random() % 2 == 0) config.window_submaps = 2 + static_cast<int32_t>(random() % 3);
  return config;
}

}  // namespace unisim::test
