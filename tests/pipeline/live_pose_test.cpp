// SPDX-License-Identifier: MIT
// When poses are given out: that of a keyframe's frame before the map takes the keyframe, and which
// are too late to act by.
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "tests/pipeline/scripted_run.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::testing;

namespace {

/// Poses of frames that newer ones were given out or seen before.
int64_t late_ones(const std::vector<LivePose>& poses) {
  return std::count_if(poses.begin(), poses.end(), [](const LivePose& pose) { return pose.late; });
}

/// Gives a frame when the one before has been tracked: none is dropped.
struct PatientCamera : Listener {
  explicit PatientCamera(Run* run) {
    run->source.before_frame = [this](int64_t frame) {
      while (frame > tracked) std::this_thread::yield();
    };
    run->listeners.push_back(this);
  }
  void on_frame(const unisim_frame&) override { ++tracked; }
  std::atomic<int64_t> tracked{0};
};

}  // namespace

TEST_CASE("with all frames posed, that of a keyframe goes out before the predictor takes it") {
  Run run;
  run.options.every_frame = true;
  std::vector<size_t> given_before;
  run.predictor.before_keyframe = [&](int32_t) {
    given_before.push_back(run.listener.live.size());
  };
  REQUIRE(run.go().outcome == Outcome::kFinished);
  REQUIRE(given_before.size() == 40);
  // Keyframe 1 begins the map; from then on frame k is the (k - 3)th that has a pose.
  for (size_t k = 2; k < 40; ++k) CHECK(given_before[k] == 5 * k - 3);
  REQUIRE(run.listener.live.size() == 200 - 4);
  for (size_t k = 1; k < run.listener.live.size(); ++k) {
    const LivePose& pose = run.listener.live[k];
    const auto frame = static_cast<int64_t>(k) + 4;
    CHECK(pose.timestamp_ns == frame * 33333333);
    CHECK(pose.keyframe_id == (frame % 5 == 0 ? frame / 5 : -1));
    CHECK(pose.segment == 0);
    CHECK(Run::distance(pose.T_world_cam, frame) < 1e-6);
  }
}

TEST_CASE("each keyframe has its pose in the map told once, after the pose of its frame") {
  const bool every_frame = GENERATE(false, true);
  Run run;
  run.options.every_frame = every_frame;
  REQUIRE(run.go().outcome == Outcome::kFinished);
  REQUIRE(run.listener.posed.size() == 40);
  for (size_t k = 0; k < 40; ++k) {
    CHECK(run.listener.posed[k].keyframe_id == static_cast<int32_t>(k));
  }
}

TEST_CASE("of a camera, poses of frames before the start are late, and of a replay none is") {
  const bool live = GENERATE(false, true);
  Run run;
  run.options.every_frame = true;
  run.options.live = live;
  run.predictor.pending_until = 13;
  PatientCamera camera(&run);
  REQUIRE(run.go().outcome == Outcome::kFinished);
  CHECK(run.listener.posed.size() == 40);
  CHECK(late_ones(run.listener.live) == (live ? 12 : 0));
  for (size_t k = 0; k < 12; ++k) CHECK(run.listener.live[k].late == live);
}

TEST_CASE("of a camera, poses that come as the run ends are late") {
  Run run(11);
  run.options.live = true;
  run.options.keyframes.stride = 1;
  run.predictor.starts_at_end = true;
  PatientCamera camera(&run);
  REQUIRE(run.go().outcome == Outcome::kFinished);
  // The last frame may make way for the end.
  CHECK(run.listener.live.size() >= 10);
  CHECK(late_ones(run.listener.live) == static_cast<int64_t>(run.listener.live.size()));
}
