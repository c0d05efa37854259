// SPDX-License-Identifier: MIT
// Metric scale: distances and units in, metres per unit out.
#include <cmath>

#include "tests/capi/odometer.hpp"

using namespace unisim;
using namespace unisim::test;

TEST_CASE("a session that was told no length is relative") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 30);
  CHECK(ask(host, 0) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("exact distances give the exact scale, in a batch and behind a sliding window") {
  const int32_t window_submaps = GENERATE(0, 2);
  World world(120, 3U);
  unisim_config config = small_windows(window_submaps);
  if (window_submaps > 0) config.skeleton_capacity = 8;
  Host host(config);
  Odometer odometer;
  walk(host, world, odometer, 110);
  const unisim_scale scale = scale_of(host);
  CHECK(scale.metres_per_unit == Approx(metres_per_unit_in_truth(host, world)).epsilon(1e-6));
  CHECK(scale.refused == 0);
  CHECK(scale.lost == 0);
  CHECK(scale.taken + scale.waiting == 27);
  CHECK(scale.sigma > 0.0);
  CHECK(scale.sigma < 0.01);
}

TEST_CASE("distances change no pose of a map that agrees with them") {
  World world(60, 3U);
  World same(60, 3U);
  Host host(small_windows(2));
  Host without(small_windows(2));
  Odometer odometer;
  walk(host, world, odometer, 50);
  feed(without, same, 50);
  without.optimize();
  for (int32_t id = 0; id < 50; ++id) {
    const Sim3 a = from_c(host.pose(id).T_world_kf);
    const Sim3 b = from_c(without.pose(id).T_world_kf);
    CHECK((a.t - b.t).norm() < 1e-5);
  }
}

TEST_CASE("one known distance across many windows is enough") {
  World world(120, 3U);
  Host host(small_windows(2));
  feed(host, world, 100);
  const double metres = kMetre * truth_between(world, 10, 60);
  REQUIRE(add(host, distance(60, 10, metres, 0.01)) == UNISIM_OK);
  host.optimize();
  const unisim_scale scale = scale_of(host);
  CHECK(scale.metres_per_unit == Approx(metres_per_unit_in_truth(host, world)).epsilon(1e-6));
  CHECK(scale.sigma == Approx(std::sqrt(0.01 * 0.01 + 0.005 * 0.005)).epsilon(0.05));
  CHECK(scale.taken == 1);
}

TEST_CASE("a distance waits for the window over its keyframes") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 7);
  REQUIRE(add(host, distance(0, 5, kMetre * truth_between(world, 0, 5), 0.01)) == UNISIM_OK);
  host.optimize();
  CHECK(ask(host, 0) == UNISIM_ERR_NOT_READY);
  feed(host, world, 3);
  CHECK(scale_of(host).taken == 1);
}

TEST_CASE("slips of the wheels do not count") {
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    World world(220, seed);
    Host host(small_windows(2));
    Odometer odometer;
    odometer.noise = 0.02;
    odometer.slips = 0.1;
    odometer.random.seed(seed);
    walk(host, world, odometer, 210);
    const unisim_scale scale = scale_of(host);
    const double error = std::log(scale.metres_per_unit / metres_per_unit_in_truth(host, world));
    CAPTURE(seed, error, scale.sigma, scale.refused);
    CHECK(std::abs(error) < 0.02);
    CHECK(scale.refused >= 1);
  }
}

TEST_CASE("the error of the scale is what its standard deviation says") {
  constexpr int kSeeds = 20;
  double chi2 = 0.0;
  int beyond = 0;
  for (uint32_t seed = 1; seed <= kSeeds; ++seed) {
    Noise noise;
    noise.rotation = 0.001;
    noise.translation = 0.001;
    noise.depth = 0.005;
    World world(220, seed, noise);
    Host host(small_windows(2));
    Odometer odometer;
    odometer.noise = 0.02;
    odometer.random.seed(100 + seed);
    walk(host, world, odometer, 210);
    const unisim_scale scale = scale_of(host);
    const double error = std::log(scale.metres_per_unit / metres_per_unit_in_truth(host, world));
    const double whitened = error / scale.sigma;
    CAPTURE(seed, error, scale.sigma);
    CHECK(scale.sigma < 0.01);
    chi2 += whitened * whitened;
    beyond += std::abs(whitened) > 3.0 ? 1 : 0;
  }
  CHECK(beyond <= 1);
  // Chi-square of 20: within 7.4 and 40 in 99 of 100 cases.
  CHECK(chi2 > 7.4);
  CHECK(chi2 < 40.0);
}

TEST_CASE("what all measurements have in common stays in the standard deviation") {
  World world(120, 3U);
  Host host(small_windows(2));
  for (int32_t k = 0; k < 100; ++k) {
    feed(host, world, 1);
    if (k % 4 != 0 || k == 0) continue;
    unisim_distance d = distance(k - 4, k, kMetre * truth_between(world, k - 4, k), 0.02);
    d.common_sigma = 0.03;
    REQUIRE(add(host, d) == UNISIM_OK);
  }
  host.optimize();
  CHECK(scale_of(host).sigma >= 0.03);
  CHECK(scale_of(host).sigma < 0.035);
}

TEST_CASE("units of submaps in metres give the scale too, and follow a new measurement") {
  World world(40, 3U);
  Host host(small_windows(2));
  host.feed(world, 7);
  const Views views = world.views(ids(0, 8));
  host.add_keyframe();
  REQUIRE(host.add_pair(world.pair(6)) == UNISIM_OK);
  const int32_t submap = host.add_submap(views);
  const double length = (from_c(views.T_submap_kf[7]).t - from_c(views.T_submap_kf[0]).t).norm();
  unisim_submap_unit unit = {};
  unit.struct_size = sizeof unit;
  unit.submap_id = submap;
  unit.source = UNISIM_METRIC_MODEL;
  unit.metres = kMetre * truth_between(world, 0, 7) / length;
  unit.sigma = 0.1;
  REQUIRE(unisim_add_submap_unit(host, &unit) == UNISIM_OK);
  host.optimize();
  const double expected = metres_per_unit_in_truth(host, world);
  CHECK(scale_of(host).metres_per_unit == Approx(expected).epsilon(1e-6));
  CHECK(scale_of(host).sigma == Approx(0.1).epsilon(0.02));

  // The window again, in a unit twice as long: half the numbers.
  std::vector<unisim_sim3> poses = views.T_submap_kf;
  for (unisim_sim3& T : poses) {
    for (double& t : T.t) t *= 0.5;
  }
  const std::vector<double> ratios(8, std::log(0.5));
  unisim_submap_update update = {};
  update.struct_size = sizeof update;
  update.submap_id = submap;
  update.count = 8;
  update.T_submap_kf = poses.data();
  update.log_depth_ratio = ratios.data();
  REQUIRE(unisim_update_submap(host, &update) == UNISIM_OK);
  host.optimize();
  CHECK(scale_of(host).metres_per_unit == Approx(expected).epsilon(1e-6));
}

TEST_CASE("scale that drifts is corrected by distances along the way") {
  const bool told = GENERATE(false, true);
  World world(220, 3U);
  Host host(small_windows(2));
  Odometer odometer;
  odometer.sigma = 0.005;
  for (int32_t k = 0; k < 210; ++k) {
    const int32_t id = host.add_keyframe();
    if (id > 0) {
      Pair pair = world.pair(id - 1);
      // The second view of each pair seems 0.1 % nearer than it is.
      for (float& pixel : pair.depth_j.pixels()) pixel *= 0.999F;
      REQUIRE(host.add_pair(pair) == UNISIM_OK);
    }
    const unisim_request request = host.next(UNISIM_REQUEST_WINDOW);
    if (request.kind != 0) {
      Views views = world.views(
          std::vector<int32_t>(request.keyframe_ids, request.keyframe_ids + request.count));
      for (size_t view = 0; view < views.depth.size(); ++view) {
        const auto factor = static_cast<float>(std::pow(0.999, static_cast<double>(view)));
        for (float& pixel : views.depth[view].pixels()) pixel *= factor;
        views.maps[view] = views.depth[view].map();
      }
      REQUIRE(host.add_submap(views) >= 0);
      host.optimize();
    }
    if (told) odometer.feed(host, world, id);
  }
  host.optimize();
  const auto step = [&](int32_t i) {
    const double length =
        (from_c(host.pose(i + 8).T_world_kf).t - from_c(host.pose(i).T_world_kf).t).norm();
    return length / truth_between(world, i, i + 8);
  };
  const double drift = std::abs(std::log(step(190) / step(4)));
  if (told) {
    CHECK(drift < 0.05);
  } else {
    CHECK(drift > 0.15);
  }
}

TEST_CASE("each segment has its own scale, and they have one when they join") {
  World world(120, 3U);
  unisim_config config = small_windows(2);
  config.lost_after = 1;
  Host host(config);
  Odometer odometer;
  for (int32_t k = 0; k < 40; ++k) {
    feed(host, world, 1);
    odometer.feed(host, world, k);
  }
  host.add_keyframe();
  REQUIRE(host.reject_pair() == UNISIM_OK);
  for (int32_t k = 41; k < 90; ++k) {
    REQUIRE(host.add_keyframe() == k);
    REQUIRE(host.add_pair(world.pair(k - 1)) == UNISIM_OK);
    const unisim_request window = host.next(UNISIM_REQUEST_WINDOW);
    if (k >= 48) odometer.feed(host, world, k);
    if (window.kind == 0) continue;
    const std::vector<int32_t> seen(window.keyframe_ids, window.keyframe_ids + window.count);
    if (seen[0] < 40) {  // over the break: nobody saw it
      REQUIRE(unisim_reject_request(host, &window) == UNISIM_OK);
    } else {
      REQUIRE(host.add_submap(world.views(seen)) >= 0);
      host.optimize();
    }
  }
  host.optimize();
  REQUIRE(host.info().segments == 2);
  const int32_t second = host.pose(80).segment;
  const auto expect_scale = [&](int32_t segment, int32_t i, int32_t j) {
    const double length =
        (from_c(host.pose(j).T_world_kf).t - from_c(host.pose(i).T_world_kf).t).norm();
    CHECK(scale_of(host, segment).metres_per_unit ==
          Approx(kMetre * truth_between(world, i, j) / length).epsilon(1e-5));
  };
  expect_scale(0, 5, 25);
  expect_scale(second, 60, 80);
  REQUIRE(host.add_loop(world.views(both(20, 70))) >= 0);
  host.optimize();
  REQUIRE(host.info().segments == 1);
  CHECK(ask(host, second) == UNISIM_ERR_NOT_READY);
  expect_scale(0, 5, 80);
}
