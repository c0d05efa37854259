// SPDX-License-Identifier: MIT
// A session saved and loaded at any moment goes on as the one that was saved, to the last bit.
#include "tests/support/catch.hpp"
#include "tests/support/owned_session.hpp"
#include "tests/support/random_config.hpp"
#include "tests/support/random_session.hpp"
#include "tests/support/same_session.hpp"
#include "tests/support/snapshot_bytes.hpp"

using namespace unisim::test;

namespace {

/// Two sessions get the same calls; now and then the second is loaded from what the first saves.
int32_t save_and_load(uint32_t seed, double garbage) {
  CAPTURE(seed, garbage);
  const unisim_config config = random_config(seed);
  OwnedSession first(config);
  OwnedSession second(config);
  Habits habits;
  habits.garbage = garbage;
  habits.keyframes = 300;
  habits.metres = seed % 2 == 0 ? 0.3 : 0.0;
  RandomCaller one(first.session, config, seed, habits);
  RandomCaller other(second.session, config, seed, habits);
  int32_t steps = 0;
  int32_t loads = 0;
  const auto step = [&] {
    const bool goes_on = one.step();
    return other.step() == goes_on && goes_on;
  };
  while (step()) {
    if (++steps % 97 != 0) continue;
    SnapshotBytes snapshot = save(first.session);
    REQUIRE(unisim_session_reset(second.session) == UNISIM_OK);
    const unisim_status status = load(second.session, &snapshot);
    if (status != UNISIM_OK) {
      const unisim_load_report report = load_report(second.session);
      FAIL("load " << status << ": problem " << report.problem << " in " << report.section << " "
                   << report.setting << " " << report.needed << " " << report.given << " at step "
                   << steps);
    }
    ++loads;
    if (!same_poses(first.session, second.session, habits.keyframes)) FAIL("poses, step " << steps);
    if (!same_info(first.session, second.session)) FAIL("counters, step " << steps);
    if (save(second.session).bytes != snapshot.bytes) FAIL("saved again, step " << steps);
  }
  CHECK(same_poses(first.session, second.session, habits.keyframes));
  CHECK(same_info(first.session, second.session));
  for (int32_t status = 0; status < 11; ++status) CHECK(one.count(status) == other.count(status));
  CHECK(one.count(UNISIM_ERR_INTERNAL) == 0);
  return loads;
}

}  // namespace

TEST_CASE("sessions loaded at random moments go on as those that saved") {
  const double garbage = GENERATE(0.0, 0.05);
  int32_t loads = 0;
  for (uint32_t seed = 1; seed < 1 + fuzz_seeds(); ++seed) loads += save_and_load(seed, garbage);
  CHECK(loads > 3 * static_cast<int32_t>(fuzz_seeds()));
}
