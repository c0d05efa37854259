// SPDX-License-Identifier: MIT
// Loops that do not agree with the map are suspended, come back, and can be taken back.
#include <cmath>
#include <string>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

/// Two places put together that are far apart.
Views false_loop(World& world, int32_t a, int32_t b) {
  Views views = world.views(both(a, b));
  for (size_t k = 4; k < 8; ++k) views.T_submap_kf[k] = views.T_submap_kf[k - 4];
  return views;
}

void optimize(Host& host, int times) {
  for (int k = 0; k < times; ++k) host.optimize();
}

unisim_loop_info loop_info(const Host& host, int32_t loop) {
  unisim_loop_info info = {};
  info.struct_size = sizeof info;
  REQUIRE(unisim_get_loop(host, loop, &info) == UNISIM_OK);
  return info;
}

void remember(int32_t, const char* text, void* user) {
  static_cast<std::string*>(user)->append(text).append("\n");
}

}  // namespace

TEST_CASE("a false loop is suspended after five optimisations, with its reason in the log") {
  std::string log;
  unisim_config config = small_windows(GENERATE(0, 2));
  config.log = remember;
  config.log_user = &log;
  World world(100, 12U);
  Host host(config);
  feed(host, world, 70);
  const int32_t loop = host.add_loop(false_loop(world, 10, 60));
  REQUIRE(loop >= 0);
  optimize(host, 4);
  CHECK(loop_info(host, loop).state == UNISIM_LOOP_ACTIVE);
  CHECK(loop_info(host, loop).residual > 0.4);
  optimize(host, 1);
  CHECK(loop_info(host, loop).state == UNISIM_LOOP_SUSPENDED);
  CHECK(host.info().suspended_loops == 1);
  CHECK(host.info().loop_suspensions == 1);
  CHECK(log.find("loop " + std::to_string(loop) + " suspended: residual") != std::string::npos);
  CHECK(host.optimize().final_cost < 1e-8);
  CHECK(worst_position_error(host, world, 70) < 1e-4);
}

TEST_CASE("a suspended loop is tried again, and stays when it agrees") {
  World world(100, 12U);
  Host host(small_windows(GENERATE(0, 2)));
  feed(host, world, 70);
  const Views bad = false_loop(world, 10, 60);
  const int32_t loop = host.add_loop(bad);
  REQUIRE(loop >= 0);
  optimize(host, 5);
  REQUIRE(loop_info(host, loop).state == UNISIM_LOOP_SUSPENDED);
  optimize(host, 11);
  CHECK(loop_info(host, loop).state == UNISIM_LOOP_SUSPENDED);
  CHECK(host.info().loop_suspensions == 1);
  const Views good = world.views(both(10, 60));
  const std::vector<double> ratios(8, std::log(good.maps[0].depth[0] / bad.maps[0].depth[0]));
  unisim_submap_update update = {};
  update.struct_size = sizeof update;
  update.submap_id = loop;
  update.count = 8;
  update.T_submap_kf = good.T_submap_kf.data();
  update.log_depth_ratio = ratios.data();
  REQUIRE(unisim_update_submap(host, &update) == UNISIM_OK);
  optimize(host, 25);
  CHECK(loop_info(host, loop).state == UNISIM_LOOP_ACTIVE);
  CHECK(loop_info(host, loop).residual < 1e-3);
  CHECK(host.info().loop_returns == 1);
  CHECK(host.info().suspended_loops == 0);
}

TEST_CASE("a suspended loop stays so when its keyframes retire") {
  World world(100, 12U);
  Host host(small_windows(2));
  feed(host, world, 70);
  const int32_t loop = host.add_loop(false_loop(world, 10, 60));
  REQUIRE(loop >= 0);
  optimize(host, 6);  // the last one without it: what retires keeps its place
  feed(host, world, 30);
  const unisim_loop_info info = loop_info(host, loop);
  CHECK(info.condensed == 1);
  CHECK(info.residual > 0.4);
  host.optimize();
  CHECK(worst_position_error(host, world, 100) < 0.01);
}

TEST_CASE("the host takes a loop back, before and after it is condensed") {
  const int32_t more = GENERATE(0, 30);
  World world(100, 12U, kNoise);
  Host host(small_windows(2));
  feed(host, world, 70);
  const int32_t loop = host.add_loop(world.views(both(10, 60)));
  REQUIRE(loop >= 0);
  host.optimize();
  feed(host, world, more);
  const int32_t edges = host.optimize().edges;
  CHECK(loop_info(host, loop).condensed == (more > 0 ? 1 : 0));
  REQUIRE(unisim_remove_loop(host, loop) == UNISIM_OK);
  CHECK(loop_info(host, loop).state == UNISIM_LOOP_REMOVED);
  CHECK(host.info().loops_removed == 1);
  CHECK(host.optimize().edges < edges);
  CHECK(unisim_remove_loop(host, loop) == UNISIM_ERR_INVALID_ARGUMENT);
  feed(host, world, 30 - more);
  host.optimize();
}

TEST_CASE("loop calls refuse what is no loop") {
  World world(60, 12U);
  Host host(small_windows(2));
  feed(host, world, 40);
  unisim_loop_info info = {};
  CHECK(unisim_get_loop(host, 0, &info) == UNISIM_ERR_ABI_MISMATCH);
  info.struct_size = sizeof info;
  CHECK(unisim_get_loop(host, 0, &info) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_get_loop(host, -1, &info) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_get_loop(host, 1000, &info) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_get_loop(host, 0, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_get_loop(nullptr, 0, &info) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_remove_loop(host, 0) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_remove_loop(host, -1) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_remove_loop(nullptr, 0) == UNISIM_ERR_INVALID_ARGUMENT);
  unisim_retired retired = {};
  CHECK(unisim_next_retired(host, &retired) == UNISIM_ERR_ABI_MISMATCH);
  CHECK(unisim_next_retired(host, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_next_retired(nullptr, &retired) == UNISIM_ERR_INVALID_ARGUMENT);
}
