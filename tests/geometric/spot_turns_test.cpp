// SPDX-License-Identifier: MIT
// When a camera has turned on the spot, and when that is settled.
#include "drivers/geometric/map/spot_turns.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace unisim::geometric {
namespace {

constexpr int kInView = 10;     // landmarks of a keyframe
constexpr double kStep = 0.15;  // rad from one keyframe to the next

State empty_state() {
  unisim_geometric_config config;
  unisim_geometric_config_init(&config, sizeof config);
  return State(config, {32, 256, 32});
}

/// A camera that turns, a circle's arc on its way: landmarks are in view for so many keyframes.
struct Turning {
  State state = empty_state();
  SpotTurns turns;
  std::vector<int32_t> seen;
  double radius;

  explicit Turning(double radius_over_depth) : radius(radius_over_depth) {
    turns.reserve(32);
    state.median_depth = 1;
    state.initialised = true;
  }

  int32_t add_landmark(int32_t id, int32_t measured_at) {
    const int32_t slot = state.map.add_landmark(0);
    Landmark& mark = state.map.landmark(slot);
    mark.state = LandmarkState::kPlaced;
    mark.measured_at = measured_at;
    state.map.observe_in(id, slot, {1, 1});
    return slot;
  }

  /// Keyframe `id`; `carried` landmarks of keyframe 0 are still in view.
  void turn(int32_t id, int carried) {
    Keyframe& keyframe = state.map.push_keyframe(id, 0);
    const double angle = kStep * id;
    const Eigen::Vector3d center(radius * std::sin(angle), 0, radius * (1 - std::cos(angle)));
    keyframe.pose.R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    keyframe.pose.t = -keyframe.pose.R * center;
    keyframe.posed = true;
    ++state.posed;
    for (int k = 0; k < kInView; ++k) {
      const int32_t slot = add_landmark(id, id);
      if (id == 0) seen.push_back(slot);
    }
    if (id > 0) see_again(id, carried);
    turns.see_keyframe(state, id);
  }

  void see_again(int32_t id, int count) {
    for (int k = 0; k < count; ++k) state.map.observe_in(id, seen[static_cast<size_t>(k)], {1, 1});
  }
};

TEST_CASE("a turn that leaves nothing measured in view is one on the spot") {
  Turning camera(0.2);
  for (int32_t id = 0; id < 8; ++id) camera.turn(id, 0);
  CHECK_FALSE(camera.turns.guessed(0, 5));  // 0.8 rad are not over before keyframe 6
  CHECK(camera.turns.guessed(6, 6));
  CHECK(camera.turns.guessed(7, 7));
  CHECK(camera.turns.guessed(0, 20));
  CHECK(camera.turns.firm_from() == 7);
}

TEST_CASE("landmarks measured before the turn and still in view carry the size over it") {
  Turning camera(0.2);
  for (int32_t id = 0; id < 8; ++id) camera.turn(id, 5);
  CHECK_FALSE(camera.turns.guessed(0, 20));
  CHECK(camera.turns.firm_from() == 0);
}

TEST_CASE("a camera that goes around something measures as it turns") {
  Turning camera(1.0);
  for (int32_t id = 0; id < 8; ++id) camera.turn(id, 0);
  CHECK_FALSE(camera.turns.guessed(0, 20));
}

TEST_CASE("landmarks from before the turn that are seen again settle it") {
  Turning camera(0.2);
  for (int32_t id = 0; id < 8; ++id) camera.turn(id, 0);
  while (camera.seen.size() < 20) camera.seen.push_back(camera.add_landmark(0, 0));
  camera.see_again(7, 19);
  camera.turns.settle(camera.state);
  CHECK(camera.turns.guessed(7, 7));
  camera.state.map.observe_in(7, camera.seen[19], {1, 1});
  camera.turns.settle(camera.state);
  CHECK_FALSE(camera.turns.guessed(0, 20));
}

TEST_CASE("a turn whose keyframes have left the map is forgotten") {
  Turning camera(0.2);
  for (int32_t id = 0; id < 8; ++id) camera.turn(id, 0);
  REQUIRE(camera.turns.guessed(7, 7));
  for (int32_t id = 100; id < 140; ++id) {
    camera.state.map.push_keyframe(id, 0).posed = true;
    camera.add_landmark(id, id);
  }
  REQUIRE_FALSE(camera.state.map.holds(7));
  camera.turns.settle(camera.state);
  CHECK_FALSE(camera.turns.guessed(0, 200));
}

}  // namespace
}  // namespace unisim::geometric
