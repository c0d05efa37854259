// SPDX-License-Identifier: MIT
// Absolute trajectory error against numbers worked out by hand.
#include "tools/eval/ate.hpp"

#include "tests/eval/trajectories.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::eval;

namespace {

Trajectory moved(const Trajectory& trajectory, double scale, const Eigen::Matrix3d& R,
                 const Eigen::Vector3d& t) {
  Trajectory out = trajectory;
  for (Pose& pose : out.poses) pose = {pose.time_s, R * pose.R, scale * (R * pose.t) + t};
  return out;
}

const Eigen::Matrix3d kTurn =
    Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();

}  // namespace

TEST_CASE("without alignment the error is the distance") {
  // Errors 0, 3, 4, 5: mean 3, median 3.5, rmse sqrt(50/4), population deviation sqrt(14/4).
  const Trajectory truth = at_positions({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}});
  const Trajectory estimate = at_positions({{0, 0, 0}, {1, 0, 3}, {5, 1, 0}, {1, 4, 5}});
  const Ate ate = absolute_trajectory_error(truth, estimate, Alignment::kNone, 0.02);
  REQUIRE(ate.error.count == 4);
  REQUIRE(ate.error.mean == Approx(3.0));
  REQUIRE(ate.error.median == Approx(3.5));
  REQUIRE(ate.error.rmse == Approx(std::sqrt(12.5)));
  REQUIRE(ate.error.std == Approx(std::sqrt(3.5)));
  REQUIRE(ate.error.min == 0.0);
  REQUIRE(ate.error.max == Approx(5.0));
  REQUIRE(ate.error.sse == Approx(50.0));
  REQUIRE(ate.T_truth_estimate.s == 1.0);
  REQUIRE(ate.distance[3] == Approx(5.0));
  REQUIRE(ate.time_s[3] == 3.0);
}

TEST_CASE("sim3 undoes a similarity") {
  const Trajectory truth = helix(50);
  const Trajectory estimate = moved(truth, 0.25, kTurn, {1, -2, 3});
  const Ate ate = absolute_trajectory_error(truth, estimate, Alignment::kSim3, 0.02);
  REQUIRE(ate.error.max < 1e-12);
  REQUIRE(ate.T_truth_estimate.s == Approx(4.0).epsilon(1e-12));
  REQUIRE((ate.T_truth_estimate.R - kTurn.transpose()).norm() < 1e-12);
}

TEST_CASE("se3 undoes a motion and keeps the scale") {
  const Trajectory truth = helix(50);
  REQUIRE(
      absolute_trajectory_error(truth, moved(truth, 1.0, kTurn, {1, -2, 3}), Alignment::kSe3, 0.02)
          .error.max < 1e-12);
  // Corners of a square at distance sqrt(2) from its centre, drawn half as large: 0.5 sqrt(2) each.
  const Trajectory square = at_positions({{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}});
  const Ate ate = absolute_trajectory_error(square, moved(square, 0.5, kTurn, {7, 0, 0}),
                                            Alignment::kSe3, 0.02);
  REQUIRE(ate.T_truth_estimate.s == 1.0);
  REQUIRE(ate.error.min == Approx(0.5 * std::sqrt(2.0)));
  REQUIRE(ate.error.max == Approx(0.5 * std::sqrt(2.0)));
}

TEST_CASE("a mirrored trajectory is not mirrored back") {
  const Trajectory truth = at_positions({{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2}, {1, 1, 1}});
  Trajectory estimate = truth;
  for (Pose& pose : estimate.poses) pose.t.z() = -pose.t.z();
  const Ate ate = absolute_trajectory_error(truth, estimate, Alignment::kSim3, 0.02);
  REQUIRE(ate.T_truth_estimate.R.determinant() == Approx(1.0));
  REQUIRE(ate.error.max > 0.1);
}

TEST_CASE("on a straight line scale and position are found, the turn about it is left open") {
  const Trajectory line = at_positions({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}});
  const Ate same = absolute_trajectory_error(line, line, Alignment::kSim3, 0.02);
  REQUIRE(same.error.max < 1e-12);
  REQUIRE(same.T_truth_estimate.roll_open);
  REQUIRE((same.T_truth_estimate.R - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  const Ate turned =
      absolute_trajectory_error(line, moved(line, 0.25, kTurn, {1, -2, 3}), Alignment::kSim3, 0.02);
  REQUIRE(turned.error.max < 1e-12);
  REQUIRE(turned.T_truth_estimate.s == Approx(4.0).epsilon(1e-12));
  REQUIRE(turned.T_truth_estimate.R.determinant() == Approx(1.0));
  const Ate back = absolute_trajectory_error(
      line, at_positions({{5, 7, 0}, {4, 7, 0}, {3, 7, 0}, {0, 7, 0}}), Alignment::kSe3, 0.02);
  REQUIRE(back.error.max < 1e-12);
}

TEST_CASE("the error to a straight line is the least that any turn gives") {
  const Trajectory line = at_positions({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}});
  // Bent by 1 in the middle: the mean height of 1/3 leaves 1/3, 2/3, 1/3 across, nothing along.
  const Trajectory bent = at_positions({{0, 0, 0}, {2, 1, 0}, {4, 0, 0}});
  const Ate ate = absolute_trajectory_error(line, bent, Alignment::kSe3, 0.02);
  REQUIRE(ate.error.rmse == Approx(std::sqrt((1.0 + 4 + 1) / 9 / 3)));
  REQUIRE(ate.T_truth_estimate.roll_open);
  REQUIRE_FALSE(absolute_trajectory_error(helix(50), helix(50), Alignment::kSim3, 0.02)
                    .T_truth_estimate.roll_open);
}

TEST_CASE("positions that do not move or are fewer than three cannot be aligned") {
  const Trajectory line = at_positions({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const Trajectory point = at_positions({{0.1, 1, 1e6}, {0.1, 1, 1e6}, {0.1, 1, 1e6}});
  const Trajectory two = at_positions({{0, 0, 0}, {1, 0, 0}});
  for (const Alignment alignment : {Alignment::kSe3, Alignment::kSim3}) {
    REQUIRE_THROWS_AS(absolute_trajectory_error(line, point, alignment, 0.02), ScoreError);
    REQUIRE_THROWS_AS(absolute_trajectory_error(point, line, alignment, 0.02), ScoreError);
    REQUIRE_THROWS_AS(absolute_trajectory_error(line, two, alignment, 0.02), ScoreError);
  }
  REQUIRE(absolute_trajectory_error(line, line, Alignment::kNone, 0.02).error.max == 0.0);
}

TEST_CASE("only associated poses count") {
  const Trajectory truth = helix(50);
  Trajectory estimate = truth;
  estimate.poses.erase(estimate.poses.begin(), estimate.poses.begin() + 40);
  estimate.poses[3].time_s += 0.04;
  const Ate ate = absolute_trajectory_error(truth, estimate, Alignment::kNone, 0.02);
  REQUIRE(ate.pairs.size() == 9);
  REQUIRE(ate.pairs[0].ground_truth == 40);
  REQUIRE(ate.error.max == 0.0);
}
