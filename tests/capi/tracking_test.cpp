// SPDX-License-Identifier: MIT
// Tracking states, held poses, segments and how they are joined.
#include <algorithm>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;
using unisim::Sim3;

namespace {

unisim_config config_of(int32_t window_size) {
  unisim_config config = default_config();
  config.max_keyframes = 64;
  config.window_size = window_size;
  config.window_overlap = 2;
  config.lost_after = 2;
  return config;
}

void feed_pairs(Host& host, World& world, int32_t first, int32_t last) {
  for (int32_t id = first; id <= last; ++id) {
    host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
}

void feed_rejected(Host& host, int32_t count) {
  for (int32_t k = 0; k < count; ++k) {
    host.add_keyframe();
    REQUIRE(host.reject_pair() == UNISIM_OK);
  }
}

}  // namespace

TEST_CASE("rejected pairs hold the pose, degrade and then lose the track") {
  World world(40, 6U);
  Host host(config_of(16));
  feed_pairs(host, world, 0, 4);
  feed_rejected(host, 1);
  CHECK(host.info().state == UNISIM_STATE_DEGRADED);
  CHECK(host.info().lost_events == 0);
  feed_rejected(host, 2);
  CHECK(host.info().state == UNISIM_STATE_LOST);
  CHECK(host.info().lost_events == 1);
  CHECK(host.info().pairs_refused == 3);
  CHECK(host.info().posed_keyframes == 5);
  CHECK(host.info().last_posed == 7);
  const unisim_pose held = host.pose(7);
  const unisim_pose last = host.pose(4);
  CHECK(held.confidence == 0);
  CHECK(held.state == UNISIM_STATE_LOST);
  CHECK(host.pose(5).state == UNISIM_STATE_DEGRADED);
  for (int k = 0; k < 3; ++k) CHECK(held.T_world_kf.t[k] == last.T_world_kf.t[k]);
}

TEST_CASE("a good pair after rejected ones starts a segment at the held pose") {
  World world(40, 6U);
  Host host(config_of(16));
  feed_pairs(host, world, 0, 4);
  feed_rejected(host, 3);
  feed_pairs(host, world, 8, 10);
  CHECK(host.info().state == UNISIM_STATE_TRACKING);
  CHECK(host.info().segments == 2);
  CHECK(host.pose(6).segment == 0);
  CHECK(host.pose(7).segment == 1);
  CHECK(host.pose(7).state == UNISIM_STATE_LOST);
  CHECK(host.pose(8).segment == 1);
  CHECK(host.pose(8).state == UNISIM_STATE_TRACKING);
  for (int k = 0; k < 3; ++k) {
    CHECK(host.pose(7).T_world_kf.t[k] == host.pose(4).T_world_kf.t[k]);
  }
  CHECK(host.optimize().final_cost < 1e-10);
}

TEST_CASE("a pair over a gap goes on in the segment and says that the track was found again") {
  World world(40, 6U);
  Host host(config_of(16));
  feed_pairs(host, world, 0, 4);
  feed_rejected(host, 3);
  host.add_keyframe();
  const Pair over = world.pair(4, 8);
  REQUIRE(host.add_pair(over) == UNISIM_OK);
  CHECK(host.info().state == UNISIM_STATE_RELOCALISED);
  CHECK(host.info().segments == 1);
  CHECK(host.pose(8).state == UNISIM_STATE_RELOCALISED);
  CHECK(host.pose(8).segment == 0);
  CHECK(host.pose(6).confidence == 0);
  feed_pairs(host, world, 9, 12);
  CHECK(host.info().state == UNISIM_STATE_TRACKING);
  CHECK(host.info().posed_keyframes == 10);
  CHECK(host.optimize().final_cost < 1e-10);
  const Sim3 moved = from_c(host.pose(4).T_world_kf).inverse() * from_c(host.pose(12).T_world_kf);
  const Sim3 truth = between(world.truth(4), world.truth(12));
  const double length = moved.t.norm() / truth.t.norm();
  CHECK((moved.t / length - truth.t).norm() < 1e-6 * truth.t.norm());
}

TEST_CASE("a pair may leave out only keyframes without a pose") {
  World world(40, 6U);
  Host host(config_of(16));
  feed_pairs(host, world, 0, 4);
  host.add_keyframe();
  CHECK(host.add_pair(world.pair(3, 5)) == UNISIM_ERR_INVALID_ARGUMENT);
  REQUIRE(host.reject_pair() == UNISIM_OK);
  host.add_keyframe();
  CHECK(host.add_pair(world.pair(3, 6)) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(host.add_pair(world.pair(6, 6)) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(host.add_pair(world.pair(4, 6)) == UNISIM_OK);
}

TEST_CASE("pairs rejected before the first good one leave the session in INIT") {
  World world(40, 6U);
  Host host(config_of(16));
  host.add_keyframe();
  feed_rejected(host, 3);
  CHECK(host.info().state == UNISIM_STATE_INIT);
  CHECK(host.info().lost_events == 0);
  unisim_pose pose = {};
  pose.struct_size = sizeof pose;
  CHECK(unisim_get_pose(host, 3, &pose) == UNISIM_ERR_NOT_READY);
  feed_pairs(host, world, 4, 5);
  CHECK(host.pose(3).segment == 0);
  CHECK(host.info().segments == 1);
  size_t count = 0;
  CHECK(unisim_get_trajectory(host, nullptr, 0, &count) == UNISIM_ERR_CAPACITY);
  CHECK(count == 3);
}

TEST_CASE("a window over two segments joins them and gives held keyframes their poses") {
  World world(40, 6U);
  Host host(config_of(10));
  feed_pairs(host, world, 0, 4);
  feed_rejected(host, 2);
  feed_pairs(host, world, 7, 9);
  CHECK(host.info().segments == 2);
  REQUIRE(host.add_submap(world.views(ids(0, 10))) == 0);
  CHECK(host.info().segments == 1);
  CHECK(host.info().posed_keyframes == 10);
  CHECK(host.info().state == UNISIM_STATE_TRACKING);
  CHECK(host.pose(5).confidence == 2);
  CHECK(host.optimize().final_cost < 1e-9);
  CHECK(worst_position_error(host, world, 10) < 1e-5);
  SECTION("and the chain goes on from a keyframe that was held") {
    feed_pairs(host, world, 10, 12);
    CHECK(host.optimize().final_cost < 1e-9);
    CHECK(worst_position_error(host, world, 13) < 1e-5);
  }
}

TEST_CASE("a loop joins two segments and relocalises") {
  World world(60, 6U);
  Host host(config_of(8));
  feed_pairs(host, world, 0, 20);
  feed_rejected(host, 4);
  CHECK(host.info().state == UNISIM_STATE_LOST);
  feed_pairs(host, world, 25, 40);
  CHECK(host.info().segments == 2);
  REQUIRE(host.add_loop(world.views({3, 4, 5, 6, 35, 36, 37, 38})) >= 0);
  CHECK(host.info().segments == 1);
  CHECK(host.info().state == UNISIM_STATE_RELOCALISED);
  CHECK(host.pose(36).segment == 0);
  CHECK(host.pose(36).confidence == 3);
  CHECK(host.pose(22).confidence == 0);
  CHECK(host.optimize().final_cost < 1e-6);
  const Sim3 truth = between(world.truth(2), world.truth(39));
  const Sim3 first = between(from_c(host.pose(2).T_world_kf), from_c(host.pose(39).T_world_kf));
  const Sim3 span = between(from_c(host.pose(2).T_world_kf), from_c(host.pose(12).T_world_kf));
  const double unit = span.t.norm() / between(world.truth(2), world.truth(12)).t.norm();
  CHECK((first.t / unit - truth.t).norm() < 1e-3);
  feed_pairs(host, world, 41, 41);
  CHECK(host.info().state == UNISIM_STATE_TRACKING);
}

TEST_CASE("a pair whose depth scatters beyond the gate is refused") {
  World world(40, 6U);
  Host host(config_of(16));
  feed_pairs(host, world, 0, 4);
  host.add_keyframe();
  Pair pair = world.pair(4);
  std::vector<float>& pixels = pair.depth_i.pixels();
  for (size_t k = 0; k < pixels.size(); ++k) pixels[k] *= k % 2 == 0 ? 1.0F : 2.0F;
  REQUIRE(host.add_pair(pair) == UNISIM_OK);
  CHECK(host.info().pairs_refused == 1);
  CHECK(host.info().state == UNISIM_STATE_DEGRADED);
  SECTION("unless its center_sigma vouches for it") {
    host.add_keyframe();
    pair = world.pair(5);
    REQUIRE(host.add_pair(pair) == UNISIM_OK);
    host.add_keyframe();
    pair = world.pair(6);
    pair.two_view.center_sigma = 0.002;
    std::vector<float>& scattered = pair.depth_i.pixels();
    for (size_t k = 0; k < scattered.size(); ++k) scattered[k] *= k % 2 == 0 ? 1.0F : 2.0F;
    REQUIRE(host.add_pair(pair) == UNISIM_OK);
    CHECK(host.info().pairs_refused == 1);
  }
}

TEST_CASE("a pair without depth in common is kept at a hundredth, a window over it decides") {
  World world(40, 6U);
  Host host(config_of(10));
  feed_pairs(host, world, 0, 4);
  host.add_keyframe();
  Pair pair = world.pair(4);
  std::fill(pair.depth_i.pixels().begin(), pair.depth_i.pixels().end(), 0.0F);
  REQUIRE(host.add_pair(pair) == UNISIM_OK);
  CHECK(host.info().pairs_refused == 0);
  feed_pairs(host, world, 6, 9);
  REQUIRE(host.add_submap(world.views(ids(0, 10))) == 0);
  const unisim_report report = host.optimize();
  CHECK(report.stop == UNISIM_STOP_CONVERGED);
  CHECK(worst_position_error(host, world, 10) < 0.02);
}
