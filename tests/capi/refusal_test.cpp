// SPDX-License-Identifier: MIT
// Why a prediction was refused, as a program reads it.
#include <cmath>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

unisim_config config_of() {
  unisim_config config = default_config();
  config.max_keyframes = 128;
  config.window_size = 6;
  config.window_overlap = 2;
  return config;
}

void multiply(Depth& depth, float factor, size_t every = 1) {
  for (size_t k = 0; k < depth.pixels().size(); k += every) depth.pixels()[k] *= factor;
}

void check(const unisim_refusal& refusal, int32_t reason, int32_t first, int32_t last) {
  CHECK(refusal.reason == reason);
  CHECK(refusal.first_keyframe == first);
  CHECK(refusal.last_keyframe == last);
}

}  // namespace

TEST_CASE("a session that has refused nothing says so") {
  Host host(config_of());
  check(host.info().refused_pair, UNISIM_REFUSED_NONE, -1, -1);
  check(host.info().refused_window, UNISIM_REFUSED_NONE, -1, -1);
  check(host.info().refused_loop, UNISIM_REFUSED_NONE, -1, -1);
}

TEST_CASE("a window says why it was refused") {
  World world(20, 8U);
  Host host(config_of());
  feed_pairs(host, world, 6);
  Views views = world.views(ids(0, 6));
  SECTION("by its gate") {
    views.center_sigma = 0.0123;
    CHECK(host.add_submap(views) == -1);
    const unisim_refusal refusal = host.info().refused_window;
    check(refusal, UNISIM_REFUSED_SIGMA, 0, 5);
    CHECK(refusal.value == 0.0123);
    CHECK(refusal.limit == 0.005);
  }
  SECTION("by its scatter") {
    for (Depth& depth : views.depth) multiply(depth, 2.0F, 2);
    CHECK(host.add_submap(views) == -1);
    const unisim_refusal refusal = host.info().refused_window;
    check(refusal, UNISIM_REFUSED_SCATTER, 0, 5);
    CHECK(refusal.value > 0.3);
    CHECK(refusal.limit == 0.13);
  }
  SECTION("for want of views") {
    for (Depth& depth : views.depth) multiply(depth, std::nanf(""));
    CHECK(host.add_submap(views) == -1);
    check(host.info().refused_window, UNISIM_REFUSED_VIEWS, 0, 5);
  }
  SECTION("for its unit") {
    for (Depth& depth : views.depth) multiply(depth, 1e-36F);
    CHECK(host.add_submap(views) == -1);
    check(host.info().refused_window, UNISIM_REFUSED_RANGE, 0, 5);
  }
  SECTION("by the host") {
    const unisim_request request = host.next(UNISIM_REQUEST_WINDOW);
    CHECK(unisim_reject_request(host, &request) == UNISIM_OK);
    check(host.info().refused_window, UNISIM_REFUSED_HOST, 0, 5);
  }
  CHECK(host.info().submaps_refused == 1);
  CHECK(host.info().refused_pair.reason == UNISIM_REFUSED_NONE);
  CHECK(host.info().refused_loop.reason == UNISIM_REFUSED_NONE);
}

TEST_CASE("an update says why it was refused") {
  World world(20, 8U);
  Host host(config_of());
  feed_pairs(host, world, 6);
  const Views views = world.views(ids(0, 6));
  REQUIRE(host.add_submap(views) == 0);
  const double ratios[6] = {};
  unisim_submap_update update = {};
  update.struct_size = sizeof update;
  update.count = 6;
  update.T_submap_kf = views.T_submap_kf.data();
  update.log_depth_ratio = ratios;
  update.center_sigma = 0.02;
  CHECK(unisim_update_submap(host, &update) == UNISIM_OK);
  check(host.info().refused_window, UNISIM_REFUSED_SIGMA, 0, 5);
  CHECK(host.info().refused_window.value == 0.02);
}

TEST_CASE("a loop says why it was refused") {
  World world(40, 8U);
  Host host(config_of());
  feed_pairs(host, world, 30);
  Views views = world.views(both(2, 20, 3));
  views.center_sigma = 0.003;
  CHECK(host.add_loop(views) == -1);
  check(host.info().refused_loop, UNISIM_REFUSED_SIGMA, 2, 22);
  CHECK(host.info().refused_loop.limit == 0.002);
  CHECK(host.info().loops_refused == 1);
}

TEST_CASE("a pair says why it was refused") {
  World world(20, 8U);
  Host host(config_of());
  feed_pairs(host, world, 6);
  host.add_keyframe();
  Pair pair = world.pair(5);
  SECTION("by its scatter") {
    multiply(pair.depth_i, 2.0F, 2);
    REQUIRE(host.add_pair(pair) == UNISIM_OK);
    check(host.info().refused_pair, UNISIM_REFUSED_SCATTER, 5, 6);
    CHECK(host.info().refused_pair.limit == 0.13);
  }
  SECTION("for its unit") {
    multiply(pair.depth_i, 1e-36F);
    REQUIRE(host.add_pair(pair) == UNISIM_OK);
    check(host.info().refused_pair, UNISIM_REFUSED_RANGE, 5, 6);
  }
  SECTION("by the host") {
    REQUIRE(host.reject_pair() == UNISIM_OK);
    check(host.info().refused_pair, UNISIM_REFUSED_HOST, 5, 6);
  }
  CHECK(host.info().pairs_refused == 1);
}

TEST_CASE("a window for which there is no room any more says so") {
  unisim_config config = config_of();
  config.max_submaps = 1;
  World world(20, 8U);
  Host host(config);
  feed_pairs(host, world, 12);
  check(host.info().refused_window, UNISIM_REFUSED_ROOM, 4, 9);
}

TEST_CASE("pairs that no prediction came for say so, and windows that too many wait with") {
  unisim_config config = small_windows(2);
  Host host(config);
  for (int32_t id = 0; id < config.max_keyframes + 8; ++id) host.add_keyframe();
  const unisim_session_info info = host.info();
  CHECK(info.refused_pair.reason == UNISIM_REFUSED_LATE);
  CHECK(info.refused_pair.last_keyframe == info.refused_pair.first_keyframe + 1);
  CHECK(info.pairs_refused > 0);
  CHECK(info.refused_window.reason == UNISIM_REFUSED_ROOM);
  CHECK(info.refused_window.last_keyframe >= info.refused_window.first_keyframe);
}
