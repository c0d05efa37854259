// SPDX-License-Identifier: MIT
// The sliding window: keyframes retire to rigid poses, the map stays right.
#include <algorithm>
#include <cmath>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

/// Largest difference of two sessions' poses, relative to the first keyframe.
double worst_difference(const Host& a, const Host& b, int32_t keyframes) {
  const unisim::Sim3 first_a = from_c(a.pose(0).T_world_kf);
  const unisim::Sim3 first_b = from_c(b.pose(0).T_world_kf);
  double worst = 0.0;
  for (int32_t id = 0; id < keyframes; ++id) {
    const unisim::Sim3 in_a = between(first_a, from_c(a.pose(id).T_world_kf));
    const unisim::Sim3 in_b = between(first_b, from_c(b.pose(id).T_world_kf));
    worst = std::max(worst, sim3_log(between(in_a, in_b)).cwiseAbs().maxCoeff());
  }
  return worst;
}

}  // namespace

TEST_CASE("exact predictions give exact poses in a sliding window") {
  unisim_config config = small_windows(GENERATE(2, 3, 5));
  config.window_overlap = GENERATE(0, 2, 5);
  World world(100, 12U);
  Host host(config);
  feed(host, world, 90);
  REQUIRE(host.add_loop(world.views(both(3, 80))) >= 0);
  REQUIRE(host.add_loop(world.views(both(10, 40))) >= 0);
  feed(host, world, 10);
  const unisim_report report = host.optimize();
  CHECK(report.final_cost < 1e-8);
  CHECK(report.keyframes < 60);
  CHECK(host.info().posed_keyframes == 100);
  CHECK(worst_position_error(host, world, 100) < 1e-4);
}

TEST_CASE("without loops the sliding window finds what the full batch finds") {
  World world_a(100, 12U, kNoise);
  World world_b(100, 12U, kNoise);
  Host batch(small_windows(0));
  Host window(small_windows(2));
  feed(batch, world_a, 100);
  feed(window, world_b, 100);
  batch.optimize();
  window.optimize();
  const double error_batch = worst_position_error(batch, world_a, 100);
  const double error_window = worst_position_error(window, world_b, 100);
  CAPTURE(error_batch, error_window, worst_difference(batch, window, 100));
  CHECK(worst_difference(batch, window, 100) < 0.2 * error_batch);
  CHECK(error_window < 1.1 * error_batch);
}

TEST_CASE("a loop moves keyframes that have long retired") {
  World world_a(100, 12U, kNoise);
  World world_b(100, 12U, kNoise);
  Host batch(small_windows(0));
  Host window(small_windows(2));
  for (Host* host : {&batch, &window}) {
    World& world = host == &batch ? world_a : world_b;
    feed(*host, world, 96);
    const double before = worst_position_error(*host, world, 96);
    const unisim::Sim3 middle = from_c(host->pose(50).T_world_kf);
    REQUIRE(host->add_loop(world.views(both(0, 90))) >= 0);
    const unisim_report report = host->optimize();
    const double after = worst_position_error(*host, world, 96);
    CAPTURE(before, after);
    CHECK(after < 0.7 * before);
    CHECK(report.first_changed <= 20);
    CHECK(report.last_changed >= 90);
    CHECK((from_c(host->pose(50).T_world_kf).t - middle.t).norm() > 1e-3);
  }
  const double error_batch = worst_position_error(batch, world_a, 96);
  const double error_window = worst_position_error(window, world_b, 96);
  CAPTURE(error_batch, error_window);
  CHECK(error_window < 1.3 * error_batch);
}

TEST_CASE("a new window waits for the next loop, or for a call without news, to move the past") {
  World world(100, 12U, kNoise);
  Host host(small_windows(2));
  feed(host, world, 60);
  REQUIRE(host.add_loop(world.views(both(2, 50))) >= 0);
  host.optimize(1);
  const unisim::Sim3 before = from_c(host.pose(20).T_world_kf);
  const int32_t newest = host.info().submaps;
  feed(host, world, 6);
  REQUIRE(host.info().submaps > newest);
  const unisim::Sim3 held = from_c(host.pose(20).T_world_kf);
  CHECK(held.t == before.t);
  CHECK(held.s == before.s);
  host.optimize();
  CHECK((from_c(host.pose(20).T_world_kf).t - held.t).norm() > 1e-9);
}

TEST_CASE("a loop whose keyframes have retired goes on holding the map") {
  World world(100, 12U, kNoise);
  Host host(small_windows(2));
  feed(host, world, 60);
  const int32_t loop = host.add_loop(world.views(both(2, 40)));
  REQUIRE(loop >= 0);
  const unisim_report before = host.optimize();
  unisim_submap_info info = {};
  info.struct_size = sizeof info;
  REQUIRE(unisim_get_submap(host, loop, &info) == UNISIM_OK);
  const unisim::Sim3 there = from_c(info.T_world_submap);
  feed(host, world, 12);
  const unisim_report after = host.optimize();
  CHECK(after.submaps == before.submaps + 2 - 1);
  REQUIRE(unisim_get_submap(host, loop, &info) == UNISIM_OK);
  CHECK(info.is_loop == 1);
  CHECK((from_c(info.T_world_submap).t - there.t).norm() < 0.05);
  CHECK(host.pose(41).confidence == 3);
}

TEST_CASE("a false loop is outvoted in the window and behind it") {
  World world(100, 12U);
  Host host(small_windows(2));
  feed(host, world, 70);
  Views views = world.views(both(10, 60));
  for (size_t k = 4; k < 8; ++k) views.T_submap_kf[k] = views.T_submap_kf[k - 4];
  REQUIRE(host.add_loop(views) >= 0);
  host.optimize();
  CHECK(worst_position_error(host, world, 70) < 0.05);
  feed(host, world, 30);
  CHECK(worst_position_error(host, world, 100) < 0.1);
}

TEST_CASE("a retired keyframe has a covariance, a retired submap keeps its measurement") {
  World world(60, 12U, kNoise);
  Host host(small_windows(2));
  feed(host, world, 60);
  host.optimize();
  double covariance[49];
  double first[49];
  REQUIRE(unisim_get_covariance(host, 20, covariance) == UNISIM_OK);
  REQUIRE(unisim_get_covariance(host, 0, first) == UNISIM_OK);
  for (int k = 0; k < 7; ++k) {
    CHECK(covariance[8 * k] > first[8 * k]);
    CHECK(first[8 * k] > 0.0);  // its submap is held, its place in the submap was measured
  }
  CHECK(first[1] == 0.0);
  const Views views = world.views(ids(0, 8));
  const std::vector<double> ratios(8, 0.3);
  unisim_submap_update update = {};
  update.struct_size = sizeof update;
  update.submap_id = 0;
  update.count = 8;
  update.T_submap_kf = views.T_submap_kf.data();
  update.log_depth_ratio = ratios.data();
  const unisim::Sim3 before = from_c(host.pose(4).T_world_kf);
  CHECK(unisim_update_submap(host, &update) == UNISIM_OK);
  CHECK((from_c(host.pose(4).T_world_kf).t - before.t).norm() == 0.0);
}

TEST_CASE("a live loop on retired keyframes takes an update") {
  World world(60, 12U);
  Host host(small_windows(2));
  feed(host, world, 58);
  const Views bad = world.views(both(3, 54));
  const int32_t loop = host.add_loop(bad);
  REQUIRE(loop >= 0);
  const Views good = world.views(both(3, 54));
  const std::vector<double> ratios(8, std::log(good.maps[0].depth[0] / bad.maps[0].depth[0]));
  unisim_submap_update update = {};
  update.struct_size = sizeof update;
  update.submap_id = loop;
  update.count = 8;
  update.T_submap_kf = good.T_submap_kf.data();
  update.log_depth_ratio = ratios.data();
  REQUIRE(unisim_update_submap(host, &update) == UNISIM_OK);
  CHECK(host.optimize().final_cost < 1e-8);
}

TEST_CASE("windows over retired keyframes are given up") {
  World world(60, 12U);
  Host host(small_windows(2));
  host.add_keyframe();
  for (int32_t id = 1; id < 40; ++id) {
    host.add_keyframe();
    REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
  for (const int32_t first : {6, 12, 18, 24}) {
    REQUIRE(host.add_submap(world.views(ids(first, 8))) >= 0);
    host.optimize();
  }
  CHECK(host.info().submaps_refused == 1);
  CHECK(host.info().refused_window.reason == UNISIM_REFUSED_LATE);
  CHECK(host.info().refused_window.first_keyframe == 0);
  const Views late = world.views(ids(0, 8));
  const unisim_submap submap = late.submap();
  int32_t id = -1;
  CHECK(unisim_add_submap(host, &submap, &id) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(host.optimize().final_cost < 1e-8);
  CHECK(worst_position_error(host, world, 40) < 1e-4);
}

TEST_CASE("refused windows leave a longer link") {
  const int32_t refused = GENERATE(1, 2, 6);
  World world(100, 12U);
  Host host(small_windows(2));
  int32_t left_out = 0;
  for (int32_t id = 0; id < 100; ++id) {
    host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
    const unisim_request request = host.next(UNISIM_REQUEST_WINDOW);
    if (request.kind == 0) continue;
    if (request.keyframe_ids[0] >= 30 && left_out < refused) {
      ++left_out;
      REQUIRE(unisim_reject_request(host, &request) == UNISIM_OK);
      continue;
    }
    const std::vector<int32_t> asked(request.keyframe_ids, request.keyframe_ids + request.count);
    REQUIRE(host.add_submap(world.views(asked)) >= 0);
    host.optimize();
  }
  REQUIRE(left_out == refused);
  CHECK(host.optimize().final_cost < 1e-8);
  CHECK(worst_position_error(host, world, 100) < 1e-4);
}

TEST_CASE("segments join behind the window too") {
  World world(100, 12U);
  Host host(small_windows(2));
  feed(host, world, 40);
  host.add_keyframe();
  REQUIRE(host.reject_pair() == UNISIM_OK);
  for (int32_t id = 41; id < 81; ++id) {
    host.add_keyframe();
    REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
    const unisim_request request = host.next(UNISIM_REQUEST_WINDOW);
    if (request.kind == 0) continue;
    const std::vector<int32_t> asked(request.keyframe_ids, request.keyframe_ids + request.count);
    if (asked.front() <= 40) {
      REQUIRE(unisim_reject_request(host, &request) == UNISIM_OK);
    } else {
      REQUIRE(host.add_submap(world.views(asked)) >= 0);
      host.optimize();
    }
  }
  CHECK(host.info().segments == 2);
  REQUIRE(host.add_loop(world.views(both(10, 70))) >= 0);
  CHECK(host.info().segments == 1);
  CHECK(host.optimize().final_cost < 1e-8);
  feed(host, world, 19);
  CHECK(host.optimize().final_cost < 1e-8);
  CHECK(worst_position_error(host, world, 100) < 1e-3);
}

TEST_CASE("a full skeleton merges and the map stays right") {
  unisim_config config = small_windows(2);
  config.skeleton_capacity = 8;
  World world(200, 12U);
  Host host(config);
  feed(host, world, 150);
  REQUIRE(host.add_loop(world.views(both(3, 140))) >= 0);
  REQUIRE(host.add_loop(world.views(both(10, 60))) >= 0);
  REQUIRE(host.add_loop(world.views(both(12, 62))) >= 0);
  feed(host, world, 50);
  CHECK(host.optimize().final_cost < 1e-8);
  CHECK(worst_position_error(host, world, 200) < 1e-3);
}

TEST_CASE("a loop corrects a full skeleton almost as it does the full batch") {
  Host batch(small_windows(0));
  unisim_config config = small_windows(2);
  config.skeleton_capacity = 8;
  Host window(config);
  World world_a(200, 12U, kNoise);
  World world_b(200, 12U, kNoise);
  double error[2] = {};
  for (Host* host : {&batch, &window}) {
    World& world = host == &batch ? world_a : world_b;
    feed(*host, world, 180);
    const double before = worst_position_error(*host, world, 180);
    REQUIRE(host->add_loop(world.views(both(0, 170))) >= 0);
    feed(*host, world, 20);
    host->optimize();
    error[host == &window] = worst_position_error(*host, world, 200);
    CAPTURE(before, error[0], error[1]);
    CHECK(error[host == &window] < 0.8 * before);
  }
  CAPTURE(error[0], error[1]);
  CHECK(error[1] < 1.5 * error[0]);
}

TEST_CASE("window_submaps is 0 or at least 2") {
  for (const int32_t value : {-1, 1, 65}) {
    const unisim_config config = small_windows(value);
    size_t size = 0;
    CHECK(unisim_arena_size(&config, &size) == UNISIM_ERR_INVALID_ARGUMENT);
  }
}
