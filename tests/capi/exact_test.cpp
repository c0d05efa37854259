// SPDX-License-Identifier: MIT
// With exact predictions the consistent graph has cost 0 and the poses are exact, whatever the
// units.
#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

TEST_CASE("exact predictions in random units give cost 0 and exact poses") {
  const int32_t overlap = GENERATE(0, 2, 8, 12);
  unisim_config config = default_config();
  config.max_keyframes = 64;
  config.window_overlap = overlap;
  World world(60, 7U);
  Host host(config);
  host.feed(world, world.size());
  const unisim_report report = host.optimize();
  CHECK(report.stop == UNISIM_STOP_CONVERGED);
  CHECK(report.final_cost < 1e-10);
  CHECK(worst_position_error(host, world, world.size()) < 1e-5);
}

TEST_CASE("the live chain is exact when the whole ratio is taken") {
  unisim_config config = default_config();
  config.live_scale_exponent = 1.0;
  World world(30, 3U);
  Host host(config);
  for (int32_t id = 0; id < world.size(); ++id) {
    host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
  CHECK(worst_position_error(host, world, world.size()) < 1e-4);
}
