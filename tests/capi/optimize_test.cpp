// SPDX-License-Identifier: MIT
// What an optimisation reports, covariances, repeatability, the paper's preset.
#include <cmath>
#include <cstring>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

Noise some_noise() {
  Noise noise;
  noise.rotation = 0.003;
  noise.translation = 0.002;
  noise.depth = 0.02;
  return noise;
}

std::vector<unisim_pose> run_of(uint32_t seed) {
  World world(60, seed, some_noise());
  Host host(default_config());
  host.feed(world, 60);
  host.optimize();
  std::vector<unisim_pose> poses(60);
  poses[0].struct_size = sizeof poses[0];
  size_t count = 0;
  REQUIRE(unisim_get_trajectory(host, poses.data(), poses.size(), &count) == UNISIM_OK);
  REQUIRE(count == 60);
  return poses;
}

}  // namespace

TEST_CASE("an empty session and a single keyframe have nothing to optimise") {
  Host host(default_config());
  CHECK(unisim_optimize(host, nullptr, nullptr) == UNISIM_ERR_NOT_READY);
  host.add_keyframe();
  CHECK(unisim_optimize(host, nullptr, nullptr) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("the report counts what is in the graph and how the past moved") {
  World world(60, 5U, some_noise());
  Host host(default_config());
  host.feed(world, 40);
  const unisim_sim3 before = host.pose(39).T_world_kf;
  const unisim_report report = host.optimize();
  CHECK(report.keyframes == 40);
  CHECK(report.submaps == 2);
  CHECK(report.edges == 39 + 2 * 32 + 2 + 1);
  CHECK(report.factor_blocks > 40);
  CHECK(report.bad_node == -1);
  CHECK(report.final_cost < report.initial_cost);
  CHECK(report.map_revision == 1);
  CHECK(report.first_changed == 1);
  CHECK(report.last_changed == 39);
  const unisim_sim3 after = host.pose(39).T_world_kf;
  double squared = 0.0;
  for (int k = 0; k < 3; ++k) squared += std::pow(after.t[k] - before.t[k], 2);
  CHECK(report.jump_translation == Approx(std::sqrt(squared)));
  CHECK(report.jump_log_scale == Approx(std::log(after.s / before.s)));
  const unisim_report again = host.optimize();
  CHECK(again.first_changed == -1);
  CHECK(again.map_revision == 1);
  CHECK(host.info().map_revision == 1);
}

TEST_CASE("the budget is a count of iterations") {
  World world(60, 5U, some_noise());
  Host host(default_config());
  host.feed(world, 60);
  const unisim_report one = host.optimize(1);
  CHECK(one.iterations == 1);
  CHECK(one.stop == UNISIM_STOP_BUDGET);
  CHECK(one.final_cost < one.initial_cost);
  unisim_budget negative = {sizeof negative, -1};
  CHECK(unisim_optimize(host, &negative, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
}

TEST_CASE("the first keyframe stays where it is") {
  World world(60, 5U, some_noise());
  Host host(default_config());
  host.feed(world, 60);
  const unisim_sim3 before = host.pose(0).T_world_kf;
  host.optimize();
  const unisim_sim3 after = host.pose(0).T_world_kf;
  CHECK(std::memcmp(&before, &after, sizeof before) == 0);
}

TEST_CASE("covariances grow away from the held keyframe and age with the graph") {
  World world(60, 5U, some_noise());
  Host host(default_config());
  host.feed(world, 50);
  double near[49];
  double far[49];
  CHECK(unisim_get_covariance(host, 3, near) == UNISIM_ERR_NOT_READY);
  host.optimize();
  REQUIRE(unisim_get_covariance(host, 0, near) == UNISIM_OK);
  for (const double value : near) CHECK(value == 0.0);
  REQUIRE(unisim_get_covariance(host, 3, near) == UNISIM_OK);
  REQUIRE(unisim_get_covariance(host, 49, far) == UNISIM_OK);
  for (int k = 0; k < 7; ++k) {
    CHECK(near[8 * k] > 0.0);
    CHECK(far[8 * k] > near[8 * k]);
    for (int m = 0; m < 7; ++m) CHECK(far[7 * k + m] == Approx(far[7 * m + k]).margin(1e-12));
  }
  host.feed(world, 1);
  CHECK(unisim_get_covariance(host, 3, near) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("the same calls with the same numbers give the same poses, bit for bit") {
  const std::vector<unisim_pose> a = run_of(21U);
  const std::vector<unisim_pose> b = run_of(21U);
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

TEST_CASE("a call that failed does not change what comes after") {
  World first(30, 21U, some_noise());
  World second(30, 21U, some_noise());
  Host plain(default_config());
  Host disturbed(default_config());
  plain.feed(first, 30);
  for (int32_t k = 0; k < 30; ++k) {
    unisim_keyframe early = {sizeof early, 0, -5};
    int32_t id = -1;
    if (k > 0) {
      CHECK(unisim_add_keyframe(disturbed, &early, &id) == UNISIM_ERR_INVALID_ARGUMENT);
      Pair pair;
      pair.two_view = {};
      pair.two_view.struct_size = sizeof pair.two_view;
      CHECK(unisim_add_two_view(disturbed, &pair.two_view) == UNISIM_ERR_INVALID_ARGUMENT);
    }
    disturbed.feed(second, 1);
  }
  plain.optimize();
  disturbed.optimize();
  for (int32_t id = 0; id < 30; ++id) {
    const unisim_pose a = plain.pose(id);
    const unisim_pose b = disturbed.pose(id);
    CHECK(std::memcmp(&a, &b, sizeof a) == 0);
  }
}

TEST_CASE("the paper's preset contradicts itself with random units, and still comes close") {
  unisim_config config = default_config();
  config.preset = UNISIM_PRESET_PAPER;
  Noise noise;
  noise.unit = 0.05;
  World world(60, 5U, noise);
  Host host(config);
  host.feed(world, 60);
  const unisim_report report = host.optimize();
  CHECK(report.final_cost > 1e-3);
  CHECK(worst_position_error(host, world, 60) < 0.3);
}

TEST_CASE("with equal units the paper's preset is exact too") {
  unisim_config config = default_config();
  config.preset = UNISIM_PRESET_PAPER;
  Noise noise;
  noise.unit = 0.0;
  World world(60, 5U, noise);
  Host host(config);
  host.feed(world, 60);
  CHECK(host.optimize().final_cost < 1e-9);
  CHECK(worst_position_error(host, world, 58) < 1e-5);
}
