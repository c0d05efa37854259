// SPDX-License-Identifier: MIT
// Random call sequences with garbage in them: never a crash, a broken session or a bad pose.
#include <memory>

#include "tests/support/catch.hpp"
#include "tests/support/proper_pose.hpp"
#include "tests/support/random_config.hpp"
#include "tests/support/random_session.hpp"

using namespace unisim::test;

namespace {

void run(uint32_t seed, double garbage, double metres = 0.0) {
  const unisim_config config = random_config(seed);
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  std::unique_ptr<unsigned char[]> arena(new unsigned char[size]);
  unisim_session* session = nullptr;
  REQUIRE(unisim_session_create(&session, &config, arena.get(), size) == UNISIM_OK);
  Habits habits;
  habits.garbage = garbage;
  habits.metres = metres;
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
  for (uint32_t seed = 1; seed < 1 + fuzz_seeds(); ++seed) run(seed, 0.0);
}

TEST_CASE("random calls with garbage in them") {
  for (uint32_t seed = 1; seed < 1 + fuzz_seeds(); ++seed) run(seed, 0.05);
}

TEST_CASE("random calls with distances that say nothing sensible") {
  for (uint32_t seed = 1; seed < 1 + fuzz_seeds(); ++seed) run(seed, 0.05, 0.5);
}
