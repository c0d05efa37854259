// SPDX-License-Identifier: MIT
// Metric scale: what is refused, comes late, is forgotten, saved and loaded.
#include <cmath>

#include "tests/capi/odometer.hpp"
#include "tests/support/snapshot_bytes.hpp"

using namespace unisim;
using namespace unisim::test;

TEST_CASE("distances and units are checked") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 20);
  const unisim_distance good = distance(3, 9, 1.0, 0.01);
  const auto expect = [&](unisim_status status, const unisim_distance& d) {
    CHECK(add(host, d) == status);
  };
  unisim_distance d = good;
  expect(UNISIM_OK, good);
  d.j = 3;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d.j = 20;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d.j = -1;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    d = good;
    d.metres = bad;
    expect(UNISIM_ERR_INVALID_ARGUMENT, d);
    d = good;
    d.sigma = bad;
    expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  }
  d = good;
  d.sigma = 1.1;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d = good;
  d.common_sigma = -0.1;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d = good;
  d.source = 4;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d = good;
  d.struct_size = 8;
  expect(UNISIM_ERR_ABI_MISMATCH, d);
  CHECK(unisim_add_distance(host, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_add_distance(nullptr, &good) == UNISIM_ERR_INVALID_ARGUMENT);

  unisim_submap_unit unit = {};
  unit.struct_size = sizeof unit;
  unit.metres = 1.0;
  unit.sigma = 0.1;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_OK);
  unit.submap_id = 100;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_ERR_INVALID_ARGUMENT);
  unit.submap_id = 0;
  unit.sigma = 0.0;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_ERR_INVALID_ARGUMENT);
  unit.sigma = 0.1;
  unit.metres = -1.0;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_add_submap_unit(host, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_get_scale(host, 0, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(ask(host, -1) == UNISIM_ERR_INVALID_ARGUMENT);
}

TEST_CASE("a distance to a keyframe that is no longer kept is said to be late") {
  World world(400, 3U);
  unisim_config config = small_windows(2);
  config.max_keyframes = 88;
  Host host(config);
  feed(host, world, 200);
  CHECK(add(host, distance(0, 190, 1.0, 0.01)) == UNISIM_ERR_RETIRED);
}

TEST_CASE("more distances than the session keeps: the oldest makes room") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 3);
  for (int32_t k = 0; k < 300; ++k) {
    REQUIRE(add(host, distance(0, 2, kMetre * truth_between(world, 0, 2), 0.01)) == UNISIM_OK);
  }
  feed(host, world, 10);
  const unisim_scale scale = scale_of(host);
  CHECK(scale.lost == 44);
  CHECK(scale.taken == 256);
}

TEST_CASE("reset forgets what a metre was") {
  World world(60, 3U);
  Host host(small_windows(2));
  Odometer odometer;
  walk(host, world, odometer, 40);
  REQUIRE(unisim_session_reset(host) == UNISIM_OK);
  CHECK(ask(host, 0) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("a saved map keeps what is known of its metre, and distances that wait") {
  const int32_t window_submaps = GENERATE(0, 2);
  World world(160, 3U);
  unisim_config config = small_windows(window_submaps);
  Host host(config);
  Odometer odometer;
  walk(host, world, odometer, 91);
  REQUIRE(scale_of(host).waiting > 0);
  SnapshotBytes snapshot = save(host);
  Host other(config);
  REQUIRE(load(other, &snapshot) == UNISIM_OK);
  other.go_on(host.info().keyframes);
  CHECK(scale_of(other).metres_per_unit == scale_of(host).metres_per_unit);
  CHECK(scale_of(other).sigma == scale_of(host).sigma);
  World again = world;
  Odometer same = odometer;
  walk(host, world, odometer, 40);
  walk(other, again, same, 40);
  CHECK(scale_of(other).metres_per_unit == scale_of(host).metres_per_unit);
  CHECK(scale_of(other).sigma == scale_of(host).sigma);
  CHECK(scale_of(other).taken == scale_of(host).taken);
}

TEST_CASE("a damaged map with a metre is refused or harmless") {
  World world(160, 3U);
  unisim_config config = small_windows(2);
  Host host(config);
  Odometer odometer;
  walk(host, world, odometer, 60);
  const SnapshotBytes good = save(host);
  for (size_t at = 0; at < good.bytes.size(); at += 97) {
    SnapshotBytes bad = good;
    bad.bytes[at] ^= 0x40U;
    Host other(config);
    CHECK(load(other, &bad) != UNISIM_OK);
  }
}
