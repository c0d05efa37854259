// SPDX-License-Identifier: MIT
// Submaps: quality gates, updates, loops, what they do to poses.
#include <cmath>
#include <string>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

unisim_config config_of(int32_t window_size, int32_t overlap) {
  unisim_config config = default_config();
  config.max_keyframes = 128;
  config.window_size = window_size;
  config.window_overlap = overlap;
  return config;
}

/// Depth ratios that scatter by 0.35 (median absolute deviation of the log).
void scatter(Views& views) {
  for (Depth& depth : views.depth) {
    for (size_t k = 0; k < depth.pixels().size(); ++k)
      depth.pixels()[k] *= k % 2 == 0 ? 1.0F : 2.0F;
  }
}

unisim_submap_update update_of(int32_t submap, const Views& views,
                               const std::vector<double>& ratios) {
  unisim_submap_update update = {};
  update.struct_size = sizeof update;
  update.submap_id = submap;
  update.count = static_cast<int32_t>(views.ids.size());
  update.T_submap_kf = views.T_submap_kf.data();
  update.log_depth_ratio = ratios.data();
  return update;
}

double log_unit_ratio(const Views& after, const Views& before) {
  return std::log(after.maps[0].depth[0] / before.maps[0].depth[0]);
}

}  // namespace

TEST_CASE("a window beyond its gate is refused as a whole") {
  World world(20, 8U);
  Host host(config_of(6, 2));
  feed_pairs(host, world, 6);
  Views views = world.views(ids(0, 6));
  SECTION("center_sigma") { views.center_sigma = 0.006; }
  SECTION("scatter, without center_sigma") { scatter(views); }
  CHECK(host.add_submap(views) == -1);
  CHECK(host.info().submaps == 0);
  CHECK(host.info().submaps_refused == 1);
  CHECK(host.next(UNISIM_REQUEST_WINDOW).kind == 0);
  CHECK(host.pose(3).confidence == 1);
  CHECK(host.optimize().submaps == 0);
}

TEST_CASE("a known center_sigma overrules scatter") {
  World world(20, 8U);
  Host host(config_of(6, 2));
  feed_pairs(host, world, 6);
  Views views = world.views(ids(0, 6));
  scatter(views);
  views.center_sigma = 0.002;
  CHECK(host.add_submap(views) == 0);
  unisim_submap_info info = {};
  info.struct_size = sizeof info;
  REQUIRE(unisim_get_submap(host, 0, &info) == UNISIM_OK);
  CHECK(info.center_sigma == 0.002);
  CHECK(info.scatter > 0.3);
  CHECK(info.is_loop == 0);
  CHECK(info.count == 6);
  CHECK(info.keyframe_ids[5] == 5);
}

TEST_CASE("loops have a gate of their own") {
  World world(40, 8U);
  Host host(config_of(6, 2));
  feed_pairs(host, world, 30);
  Views views = world.views({2, 3, 4, 20, 21, 22});
  views.center_sigma = 0.003;
  CHECK(host.add_loop(views) == -1);
  CHECK(host.info().loops_refused == 1);
  views.center_sigma = 0.0015;
  CHECK(host.add_loop(views) == 0);
  CHECK(host.info().loops == 1);
  CHECK(host.pose(21).confidence == 3);
}

TEST_CASE("a less certain window pulls less") {
  const auto pull = [](double center_sigma) {
    World world(20, 8U);
    Host host(config_of(6, 2));
    feed_pairs(host, world, 6);
    host.optimize();
    Views views = world.views(ids(0, 6));
    views.T_submap_kf[5].t[0] += 0.3;
    views.center_sigma = center_sigma;
    REQUIRE(host.add_submap(views) == 0);
    host.optimize();
    return worst_position_error(host, world, 6);
  };
  CHECK(pull(0.004) < 0.5 * pull(0.001));
  CHECK(pull(0.0005) == Approx(pull(0.001)));
}

TEST_CASE("views without usable depth take no part, too few of them refuse the window") {
  World world(20, 8U);
  Host host(config_of(6, 2));
  feed_pairs(host, world, 6);
  Views views = world.views(ids(0, 6));
  const auto blind = static_cast<size_t>(GENERATE(1, 5));
  for (size_t k = 0; k < blind; ++k) {
    for (float& pixel : views.depth[k].pixels()) pixel = std::nanf("");
  }
  const bool refused = blind == 5;
  CHECK(host.add_submap(views) == (refused ? -1 : 0));
  CHECK(host.pose(0).confidence == 1);
  CHECK(host.pose(5).confidence == (refused ? 1 : 2));
  CHECK(host.optimize().final_cost < 1e-9);
}

TEST_CASE("the least confident pixels are left out of ratios") {
  World world(20, 8U);
  unisim_config config = config_of(6, 2);
  config.confidence_drop = 0.5;
  config.scatter_gate = 0.01;
  Host host(config);
  feed_pairs(host, world, 6);
  Views views = world.views(ids(0, 6));
  std::vector<float> confidence(views.depth[0].pixels().size());
  for (size_t k = 0; k < confidence.size(); ++k) confidence[k] = k % 20 < 9 ? 0.1F : 0.9F;
  for (size_t v = 0; v < views.depth.size(); ++v) {
    for (size_t k = 0; k < confidence.size(); ++k) {
      if (k % 20 < 9) views.depth[v].pixels()[k] *= 5.0F;
    }
    views.maps[v].confidence = confidence.data();
  }
  CHECK(host.add_submap(views) == 0);
  CHECK(host.optimize().final_cost < 1e-9);
}

TEST_CASE("an update replaces the measurement, in whatever unit it comes") {
  World world(20, 8U);
  Host host(config_of(10, 4));
  feed_pairs(host, world, 16);
  Views bad = world.views(ids(0, 10));
  for (size_t k = 0; k < 10; ++k) bad.T_submap_kf[k].t[1] += 0.05 * static_cast<double>(k * k);
  REQUIRE(host.add_submap(bad) == 0);
  REQUIRE(host.add_submap(world.views(ids(6, 10))) == 1);
  host.optimize();
  CHECK(worst_position_error(host, world, 16) > 0.1);
  const Views good = world.views(ids(0, 10));
  const std::vector<double> ratios(10, log_unit_ratio(good, bad));
  unisim_submap_update update = update_of(0, good, ratios);
  REQUIRE(unisim_update_submap(host, &update) == UNISIM_OK);
  const unisim_report report = host.optimize();
  CHECK(report.final_cost < 1e-9);
  CHECK(report.first_changed == 1);
  CHECK(worst_position_error(host, world, 16) < 1e-5);
  SECTION("and the next window ties to the new one") {
    for (int32_t id = 16; id < 20; ++id) {
      host.add_keyframe();
      if (id < 20) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
    }
    REQUIRE(unisim_close_window(host) == UNISIM_OK);
    REQUIRE(host.add_submap(world.views(ids(12, 8))) == 2);
    CHECK(host.optimize().final_cost < 1e-9);
  }
}

TEST_CASE("an update beyond the gate is refused and the old measurement stays") {
  World world(20, 8U);
  Host host(config_of(10, 4));
  feed_pairs(host, world, 10);
  const Views views = world.views(ids(0, 10));
  REQUIRE(host.add_submap(views) == 0);
  host.optimize();
  Views worse = views;
  for (size_t k = 0; k < 10; ++k) worse.T_submap_kf[k].t[1] += 0.05 * static_cast<double>(k * k);
  const std::vector<double> ratios(10, 0.0);
  unisim_submap_update update = update_of(0, worse, ratios);
  update.center_sigma = 0.02;
  CHECK(unisim_update_submap(host, &update) == UNISIM_OK);
  CHECK(host.info().submaps_refused == 1);
  CHECK(host.optimize().final_cost < 1e-9);
}

TEST_CASE("updates that drive a unit out of the range of numbers are invalid, nothing breaks") {
  const double step = GENERATE(20.0, -20.0);
  const bool origin_alone = GENERATE(false, true);
  World world(30, 8U);
  Host host(config_of(10, 4));
  feed_pairs(host, world, 16);
  const Views views = world.views(ids(0, 10));
  REQUIRE(host.add_submap(views) == 0);
  REQUIRE(host.add_submap(world.views(ids(6, 10))) == 1);
  std::vector<double> ratios(10, origin_alone ? 0.0 : step);
  ratios[5] = step;
  const unisim_submap_update update = update_of(0, views, ratios);
  unisim_status status = UNISIM_OK;
  for (int32_t k = 0; k < 100 && status == UNISIM_OK; ++k) {
    status = unisim_update_submap(host, &update);
  }
  CHECK(status == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_update_submap(host, &update) == UNISIM_ERR_INVALID_ARGUMENT);
  SECTION("also with an optimisation between") {
    CHECK(unisim_optimize(host, nullptr, nullptr) != UNISIM_ERR_INTERNAL);
    CHECK(unisim_update_submap(host, &update) != UNISIM_ERR_INTERNAL);
  }
  SECTION("the way back is open") {
    for (double& ratio : ratios) ratio = -ratio;
    CHECK(unisim_update_submap(host, &update) == UNISIM_OK);
  }
  CHECK(host.pose(3).confidence == 2);
}

TEST_CASE("a window whose unit is out of the range of numbers is refused") {
  const float unit = GENERATE(1e-36F, 1e36F);
  World world(30, 8U);
  Host host(config_of(6, 2));
  feed_pairs(host, world, 6);
  Views views = world.views(ids(0, 6));
  for (Depth& depth : views.depth) {
    for (float& pixel : depth.pixels()) pixel *= unit;
  }
  CHECK(host.add_submap(views) == -1);
  CHECK(host.info().submaps_refused == 1);
  CHECK(host.optimize().submaps == 0);
}

TEST_CASE("segments that leap in scale, again and again, are joined or refused, nothing breaks") {
  World world(200, 8U);
  unisim_config config = config_of(6, 2);
  config.max_keyframes = 200;
  Host host(config);
  const auto joined = [&](int32_t from) {
    // A loop that sees the second half thirty orders of magnitude nearer.
    Views views = world.views(both(from - 6, from + 2, 3));
    for (size_t k = 3; k < 6; ++k) {
      for (float& pixel : views.depth[k].pixels()) pixel *= 1e-29F;
    }
    return views;
  };
  host.add_keyframe();
  for (int32_t id = 1; id < 200; ++id) {
    host.add_keyframe();
    if (id % 10 == 0) {
      REQUIRE(host.reject_pair() == UNISIM_OK);
    } else {
      REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
    }
    if (id % 10 != 8 || id < 18) continue;
    const Views views = joined(id - 5);
    const unisim_submap loop = views.submap();
    int32_t made = -1;
    REQUIRE(unisim_add_loop(host, &loop, &made) == UNISIM_OK);
    const unisim_status status = unisim_optimize(host, nullptr, nullptr);
    REQUIRE((status == UNISIM_OK || status == UNISIM_ERR_NUMERICAL));
  }
  CHECK(host.info().loops_refused > 0);
}

TEST_CASE("windows take most of the drift out of a noisy chain, a loop takes more") {
  Noise noise;
  noise.rotation = 0.004;
  noise.translation = 0.002;
  noise.depth = 0.02;
  World world(100, 12U, noise);
  Host chain(config_of(16, 2));
  Host host(config_of(16, 2));
  feed_pairs(chain, world, 100);
  host.feed(world, 100);
  chain.optimize();
  const double pairs_only = worst_position_error(chain, world, 100);
  host.optimize();
  const double windows = worst_position_error(host, world, 100);
  std::vector<int32_t> both = ids(0, 8);
  for (const int32_t id : ids(92, 8)) both.push_back(id);
  REQUIRE(host.add_loop(world.views(both)) >= 0);
  const unisim_report report = host.optimize();
  const double loop = worst_position_error(host, world, 100);
  CAPTURE(pairs_only, windows, loop);
  CHECK(windows < pairs_only);
  CHECK(loop < 0.7 * windows);
  CHECK(report.map_revision > 0);
}

TEST_CASE("a false loop is outvoted") {
  World world(100, 12U);
  Host host(config_of(16, 2));
  host.feed(world, 100);
  host.optimize();
  std::vector<int32_t> both = ids(10, 8);
  for (const int32_t id : ids(60, 8)) both.push_back(id);
  Views views = world.views(both);
  for (size_t k = 8; k < 16; ++k) views.T_submap_kf[k] = views.T_submap_kf[k - 8];
  REQUIRE(host.add_loop(views) >= 0);
  host.optimize();
  CHECK(worst_position_error(host, world, 100) < 0.05);
}

TEST_CASE("disabled factors leave no edges") {
  const auto edges = [](uint32_t disabled) {
    unisim_config config = config_of(6, 2);
    config.disabled_factors = disabled;
    World world(20, 8U);
    Host host(config);
    host.feed(world, 10);
    return host.optimize().edges;
  };
  const int32_t all = edges(0);
  CHECK(all == 9 + 12 + 12 + 2 + 1);
  CHECK(edges(UNISIM_FACTOR_TWO_VIEW) == all - 9);
  CHECK(edges(UNISIM_FACTOR_BRIDGE) == all - 12);
  CHECK(edges(UNISIM_FACTOR_SCALE_ANCHOR) == all - 12);
  CHECK(edges(UNISIM_FACTOR_TIE) == all - 2);
  CHECK(edges(UNISIM_FACTOR_SCALE) == all - 1);
  CHECK(edges(UNISIM_FACTOR_BRIDGE | UNISIM_FACTOR_TIE) == all - 14);
  CHECK(edges(UNISIM_FACTOR_TIE | UNISIM_FACTOR_SCALE) == all - 3);
  CHECK(edges(UNISIM_FACTOR_BRIDGE | UNISIM_FACTOR_SCALE_ANCHOR) == all - 24);
}

TEST_CASE("the log says why something was refused") {
  std::string text;
  unisim_config config = config_of(6, 2);
  config.log_user = &text;
  config.log = [](int32_t level, const char* line, void* user) {
    CHECK(level == UNISIM_LOG_WARNING);
    *static_cast<std::string*>(user) = line;
  };
  World world(20, 8U);
  Host host(config);
  feed_pairs(host, world, 6);
  Views views = world.views(ids(0, 6));
  views.center_sigma = 0.0123;
  CHECK(host.add_submap(views) == -1);
  CHECK(text == "window of keyframes 0..5 refused: center sigma 0.0123 over 0.0050");
}
