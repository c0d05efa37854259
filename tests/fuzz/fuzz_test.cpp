// SPDX-License-Identifier: MIT
// Random call sequences with garbage in them: never a crash, a broken session or a bad pose.
#include <cmath>
#include <cstdlib>
#include <memory>

#include "tests/support/catch.hpp"
#include "tests/support/random_session.hpp"

using namespace unisim::test;

namespace {

// Seeds that find something are kept in the range.
constexpr uint32_t kFirstSeed = 1;
constexpr uint32_t kSeeds = 60;

/// UNISIM_FUZZ_SEEDS asks for a longer run by hand.
uint32_t seeds() {
  const char* text = std::getenv("UNISIM_FUZZ_SEEDS");
  return text == nullptr ? kSeeds : static_cast<uint32_t>(std::strtoul(text, nullptr, 10));
}

unisim_config config_of(uint32_t seed) {
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

bool is_pose(const unisim_sim3& T) {
  double norm = 0.0;
  for (const double value : T.q) norm += value * value;
  bool finite = std::isfinite(T.s) && T.s > 0.0;
  for (const double value : T.t) finite = finite && std::isfinite(value);
  return finite && std::abs(norm - 1.0) < 1e-6;
}

void run(uint32_t seed, double garbage) {
  const unisim_config config = config_of(seed);
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  std::unique_ptr<unsigned char[]> arena(new unsigned char[size]);
  unisim_session* session = nullptr;
  REQUIRE(unisim_session_create(&session, &config, arena.get(), size) == UNISIM_OK);
  Habits habits;
  habits.garbage = garbage;
  habits.keyframes = 400;  // beyond what a sliding window keeps
  RandomCaller caller(session, config, seed, habits);
  while (caller.step()) {
  }
  CAPTURE(seed, garbage);
  CHECK(caller.count(UNISIM_ERR_INTERNAL) == 0);
  CHECK(caller.count(UNISIM_ERR_ABI_MISMATCH) == 0);
  CHECK(caller.solver_overflows() == 0);
  for (int32_t id = 0; id < habits.keyframes; ++id) {
    unisim_pose pose = {};
    pose.struct_size = sizeof pose;
    if (unisim_get_pose(session, id, &pose) != UNISIM_OK) continue;
    if (!is_pose(pose.T_world_kf)) FAIL_CHECK("keyframe " << id << " has no proper pose");
  }
}

}  // namespace

TEST_CASE("random calls with good numbers") {
  for (uint32_t seed = kFirstSeed; seed < kFirstSeed + seeds(); ++seed) run(seed, 0.0);
}

TEST_CASE("random calls with garbage in them") {
  for (uint32_t seed = kFirstSeed; seed < kFirstSeed + seeds(); ++seed) run(seed, 0.05);
}
