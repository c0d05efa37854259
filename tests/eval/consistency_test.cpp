// SPDX-License-Identifier: MIT
// Errors over standard deviations, against figures of numpy (make_consistency.py).
#include "tools/eval/consistency.hpp"

#include "tests/eval/trajectories.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"

using namespace unisim::eval;

namespace {

struct JudgedRun {
  Trajectory truth{"truth", "tum", {}, 0};
  Trajectory estimate{"estimate", "tum", {}, 0};
  std::vector<KeyframeClaim> claims;
};

Eigen::Matrix3d rotated(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// That of make_consistency.py: two segments in another frame and of other sizes, one pose far off.
JudgedRun judged_run() {
  JudgedRun run;
  const Eigen::Matrix3d turn = rotated({1, 2, 3}, 2.0);
  for (int k = 0; k < 40; ++k) {
    const double a = 0.1 * k;
    const Pose truth = {a, rotated({0.1, 1.0, 0.2}, a), {std::cos(a), 0.05 * a, std::sin(a)}};
    const double size = k == 26 ? 0.6 : 0.01;
    const Eigen::Vector3d wrong =
        size * Eigen::Vector3d(std::sin(3.0 * k), std::cos(5.0 * k), std::sin(7.0 * k));
    const double scale = k < 12 ? 0.5 : 2.0;
    run.truth.poses.push_back(truth);
    run.estimate.poses.push_back(
        {a,
         turn * truth.R * rotated({1, 0, 1}, 0.02) * rotated({0, 1, 0}, 0.003 * std::sin(11.0 * k)),
         scale * (turn * (truth.t + wrong)) + Eigen::Vector3d(1, -2, 3)});
    KeyframeClaim claim;
    claim.time_s = a;
    claim.segment = k < 12 ? 0 : 1;
    claim.good = k != 3;
    claim.confidence = k % 4 == 0 ? 2 : 3;
    claim.position_sigma = k == 5 ? -1.0 : scale * (0.004 + 0.0002 * k);
    claim.rotation_sigma = k == 5 ? -1.0 : 0.5 * claim.position_sigma;
    run.claims.push_back(claim);
  }
  return run;
}

}  // namespace

TEST_CASE("ratios are those that numpy finds") {
  const JudgedRun run = judged_run();
  const Consistency found = consistency(run.truth, run.estimate, run.claims, 0.02);
  CHECK(found.segments == 2);
  CHECK(found.without_sigma == 1);
  CHECK(found.position.count == 39);
  CHECK(found.position.beyond_3 == Approx(0.179487179));
  CHECK(found.position.median == Approx(2.180226441));
  CHECK(found.position.p95 == Approx(3.794153040));
  CHECK(found.position.max == Approx(41.368453178));
  CHECK(found.rotation.count == 39);
  CHECK(found.rotation.beyond_3 == Approx(0.512820513));
  CHECK(found.rotation.median == Approx(3.023014281));
  CHECK(found.rotation.p95 == Approx(15.646454536));
  CHECK(found.rotation.max == Approx(22.848635923));
  CHECK(found.good == 39);
  CHECK(found.good_far_off == 1);
  CHECK(found.by_confidence.at(2).count == 10);
  CHECK(found.by_confidence.at(2).median == Approx(0.017305011));
  CHECK(found.by_confidence.at(3).median == Approx(0.016904109));
}

TEST_CASE("a pose far off that is said to be bad is not counted") {
  JudgedRun run = judged_run();
  run.claims[26].good = false;
  CHECK(consistency(run.truth, run.estimate, run.claims, 0.02).good_far_off == 0);
}

TEST_CASE("a segment without truth is left out, a run without any is an error") {
  JudgedRun run = judged_run();
  Trajectory part = run.truth;
  part.poses.resize(12);
  const Consistency found = consistency(part, run.estimate, run.claims, 0.02);
  CHECK(found.segments == 1);
  CHECK(found.segments_skipped == 1);
  for (Pose& pose : part.poses) pose.time_s += 1000;
  CHECK_THROWS_AS(consistency(part, run.estimate, run.claims, 0.02), ScoreError);
  CHECK_THROWS_AS(consistency(run.truth, run.estimate, {}, 0.02), ScoreError);
}

TEST_CASE("a keyframe table is read by the names of its columns") {
  const TempFolder folder;
  const std::string path =
      folder.write("keyframes.csv",
                   "state,timestamp,segment,reason,confidence,rotation_sigma,position_sigma\n"
                   "tracking,0.5,0,no start yet,2,0.25,0.125\ndegraded,0.75,1,,1,,\n");
  const std::vector<KeyframeClaim> claims = read_keyframe_table(path);
  REQUIRE(claims.size() == 2);
  CHECK(claims[0].time_s == 0.5);
  CHECK(claims[0].good);
  CHECK(claims[0].confidence == 2);
  CHECK(claims[0].position_sigma == 0.125);
  CHECK(claims[0].rotation_sigma == 0.25);
  CHECK(claims[1].segment == 1);
  CHECK_FALSE(claims[1].good);
  CHECK(claims[1].position_sigma < 0.0);
  CHECK_THROWS_AS(read_keyframe_table(folder.write("a.csv", "id,timestamp\n0,1\n")), InputError);
  CHECK_THROWS_AS(
      read_keyframe_table(folder.write(
          "b.csv",
          "state,timestamp,segment,confidence,rotation_sigma,position_sigma\ntracking,x,0,1,,\n")),
      InputError);
  CHECK_THROWS_AS(
      read_keyframe_table(folder.write(
          "c.csv",
          "state,timestamp,segment,confidence,rotation_sigma,position_sigma\ntracking,0\n")),
      InputError);
}
