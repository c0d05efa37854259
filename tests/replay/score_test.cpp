// SPDX-License-Identifier: MIT
// Scores of a run against ground truth of every shape: sparse, short, straight, broken into
// segments.
#include <cmath>

#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "tools/replay/scores.hpp"

using namespace unisim;
using replay::KeyframeRow;
using replay::RunData;
using replay::Scores;

namespace {

constexpr double kSlow = 0.3;  // rad/s: a curve that straight lines of 0.2 s follow to 2 mm

Eigen::Vector3d on_curve(double time_s) {
  return {2 * std::cos(kSlow * time_s), 2 * std::sin(kSlow * time_s), 0.1 * time_s};
}

unisim_sim3 pose_at(double time_s, double scale) {
  const Eigen::Vector3d t = scale * on_curve(time_s);
  return {{0, 0, 0, 1}, {t.x(), t.y(), t.z()}, 1.0};
}

int64_t to_ns(double time_s) { return std::llround(time_s * 1e9); }

void add_keyframe(double time_s, double scale, int32_t segment, RunData* run) {
  unisim_pose pose{};
  pose.keyframe_id = static_cast<int32_t>(run->keyframes.size());
  pose.timestamp_ns = to_ns(time_s);
  pose.T_world_kf = pose_at(time_s, scale);
  pose.confidence = 2;
  pose.segment = segment;
  run->keyframes.push_back({pose, 0, -1});
  run->trajectory.push_back({pose.timestamp_ns, pose.T_world_kf});
  run->live.push_back(run->trajectory.back());
}

/// Keyframes every 0.2 s for 10 s, half the size of the truth.
RunData run_of_ten_seconds() {
  RunData run;
  for (int k = 0; k < 50; ++k) add_keyframe(0.2 * k, 0.5, 0, &run);
  return run;
}

eval::Trajectory truth_at(double first_s, double step_s, int count) {
  eval::Trajectory truth{"truth.txt", "tum", {}, 0};
  for (int k = 0; k < count; ++k) {
    const double time_s = first_s + step_s * k;
    truth.poses.push_back({time_s, Eigen::Matrix3d::Identity(), on_curve(time_s)});
  }
  return truth;
}

}  // namespace

TEST_CASE("keyframes that meet the ground truth are compared as they are") {
  const Scores scores = score(truth_at(0, 0.01, 1000), run_of_ten_seconds());
  REQUIRE(scores.ate);
  CHECK(scores.ate->error.rmse < 1e-9);
  CHECK(scores.ate->T_truth_estimate.s == Approx(2.0));
  CHECK(scores.poses == "keyframes");
  CHECK(scores.problem.empty());
  REQUIRE(scores.segments.size() == 1);
  CHECK(scores.segments[0].keyframes == 50);
}

TEST_CASE("ground truth once a second is met between the keyframes") {
  const Scores scores = score(truth_at(0.1, 1.0, 10), run_of_ten_seconds());
  REQUIRE(scores.ate);
  CHECK(scores.ate->pairs.size() == 10);
  CHECK(scores.ate->error.rmse < 0.002);
  CHECK(scores.poses == "keyframes, interpolated at the times of ground truth");
  CHECK(scores.live_poses == "live poses, interpolated at the times of ground truth");
  CHECK(scores.rpe);
}

TEST_CASE("all frames are compared where the keyframes do not meet the ground truth") {
  RunData run = run_of_ten_seconds();
  for (int k = 0; k < 100; ++k) run.frames.push_back({to_ns(0.1 * k), pose_at(0.1 * k, 0.5)});
  const Scores scores = score(truth_at(0.1, 1.0, 10), run);
  REQUIRE(scores.ate);
  CHECK(scores.ate->pairs.size() == 10);
  CHECK(scores.ate->error.rmse < 1e-9);
  CHECK(scores.poses == "all frames");
}

TEST_CASE("dense ground truth of other times is met at the times of the keyframes") {
  const Scores scores = score(truth_at(0.05, 0.1, 100), run_of_ten_seconds());
  REQUIRE(scores.ate);
  CHECK(scores.ate->pairs.size() == 49);
  CHECK(scores.ate->error.rmse < 0.002);
  CHECK(scores.poses == "keyframes, ground truth interpolated at their times");
}

TEST_CASE("nothing is interpolated across a long gap") {
  RunData run;
  for (int k = 0; k < 10; ++k) add_keyframe(2.0 * k, 1.0, 0, &run);
  const Scores scores = score(truth_at(1.0, 2.0, 9), run);
  CHECK_FALSE(scores.ate);
  CHECK(has(scores.problem, "truth.txt: no score"));
}

TEST_CASE("what leaves no score is said without options of another program") {
  const RunData run = run_of_ten_seconds();
  eval::Trajectory still = truth_at(0, 0.01, 1000);
  for (eval::Pose& pose : still.poses) pose.t = {1, 2, 3};
  const std::vector<eval::Trajectory> truths = {truth_at(0, 5.0, 2), truth_at(500, 0.01, 10),
                                                still};
  for (const eval::Trajectory& truth : truths) {
    const Scores scores = score(truth, run);
    CHECK_FALSE(scores.ate);
    CHECK_FALSE(scores.problem.empty());
    INFO(scores.problem);
    CHECK(has(scores.problem, "--every-frame") == (&truth == &truths[0]));
    for (const char* option : {"--max-dt", "--align", "--delta", "--unit"}) {
      CHECK_FALSE(has(scores.problem, option));
    }
  }
}

TEST_CASE("a straight line is scored by scale and position") {
  RunData run;
  eval::Trajectory truth{"truth.txt", "tum", {}, 0};
  for (int k = 0; k < 20; ++k) {
    add_keyframe(k, 1.0, 0, &run);
    run.trajectory.back().T_world_cam = {{0, 0, 0, 1}, {0, 0.5 * k, 0}, 1.0};
    truth.poses.push_back({static_cast<double>(k), Eigen::Matrix3d::Identity(), {1.0 * k, 0, 7}});
  }
  const Scores scores = score(truth, run);
  REQUIRE(scores.ate);
  CHECK(scores.ate->error.rmse < 1e-9);
  CHECK(scores.ate->T_truth_estimate.s == Approx(2.0));
}

TEST_CASE("each segment has the error of its own alignment") {
  RunData run;
  for (int k = 0; k < 30; ++k) add_keyframe(0.2 * k, 0.5, 0, &run);
  for (int k = 31; k < 50; ++k) add_keyframe(0.2 * k, 3.0, 1, &run);
  add_keyframe(10.5, 1.0, 2, &run);
  const Scores scores = score(truth_at(0, 0.01, 1100), run);
  REQUIRE(scores.ate);
  CHECK(scores.ate->error.rmse > 0.1);
  REQUIRE(scores.segments.size() == 3);
  CHECK(scores.segments[0].first == 0);
  CHECK(scores.segments[0].last == 29);
  CHECK(*scores.segments[0].ate_rmse_m < 1e-9);
  CHECK(scores.segments[1].first == 30);
  CHECK(scores.segments[1].keyframes == 19);
  CHECK(*scores.segments[1].ate_rmse_m < 1e-9);
  CHECK_FALSE(scores.segments[2].ate_rmse_m);
  const Scores without = score({}, run);
  CHECK(without.segments.size() == 3);
  CHECK_FALSE(without.segments[0].ate_rmse_m);
}
