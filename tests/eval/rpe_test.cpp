// SPDX-License-Identifier: MIT
// Relative pose error against numbers worked out by hand.
#include "tools/eval/rpe.hpp"

#include "tests/eval/trajectories.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::eval;

namespace {

constexpr double kPi = 3.14159265358979323846;

// One metre per second along x.
Trajectory straight(size_t count) {
  std::vector<Eigen::Vector3d> positions;
  for (size_t k = 0; k < count; ++k) positions.emplace_back(static_cast<double>(k), 0, 0);
  return at_positions(positions);
}

Rpe compare(const Trajectory& truth, const Trajectory& estimate, const RpeStep& step) {
  return relative_pose_error(truth, estimate, Alignment::kNone, 0.02, step);
}

}  // namespace

TEST_CASE("a frame that jumps is an error of the step before and after it") {
  Trajectory estimate = straight(5);
  estimate.poses[2].t.y() = 0.5;
  const Rpe rpe = compare(straight(5), estimate, {});
  REQUIRE(rpe.translation_error == std::vector<double>{0.0, 0.5, 0.5, 0.0});
  REQUIRE(rpe.translation.rmse == Approx(std::sqrt(0.125)));
  REQUIRE(rpe.rotation_deg.max == 0.0);
  REQUIRE(rpe.time_s == std::vector<double>{1, 2, 3, 4});
}

TEST_CASE("a drift per metre grows with the step") {
  Trajectory estimate = straight(9);
  for (Pose& pose : estimate.poses) pose.t *= 1.1;
  REQUIRE(compare(straight(9), estimate, {1, StepUnit::kFrames, false}).translation.mean ==
          Approx(0.1));
  const Rpe four = compare(straight(9), estimate, {4, StepUnit::kFrames, false});
  REQUIRE(four.translation_error.size() == 2);
  REQUIRE(four.translation.mean == Approx(0.4));
  REQUIRE(compare(straight(9), estimate, {4, StepUnit::kFrames, true}).translation_error.size() ==
          5);
}

TEST_CASE("rotation is the angle of the difference") {
  Trajectory estimate = straight(3);
  estimate.poses[1].R = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  estimate.poses[2].R = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Rpe rpe = compare(straight(3), estimate, {});
  REQUIRE(rpe.rotation_error_deg[0] == Approx(0.3 * 180 / kPi));
  REQUIRE(rpe.rotation_error_deg[1] == Approx((kPi - 0.3) * 180 / kPi));
}

TEST_CASE("steps in metres follow the path of the estimate") {
  const Rpe rpe = compare(straight(11), straight(11), {2.5, StepUnit::kMetres, false});
  REQUIRE(rpe.time_s == std::vector<double>{3, 6, 9});
  const Rpe all = compare(straight(11), straight(11), {3.2, StepUnit::kMetres, true});
  REQUIRE(all.time_s == std::vector<double>{3, 4, 5, 6, 7, 8, 9, 10});
}

TEST_CASE("steps in seconds bear rates that do not divide a second") {
  Trajectory trajectory = helix(61);
  for (size_t k = 0; k < 61; ++k) {
    trajectory.poses[k].time_s = std::floor(1e6 * static_cast<double>(k) / 30.0) * 1e-6;
  }
  const Rpe rpe = compare(trajectory, trajectory, {1, StepUnit::kSeconds, false});
  REQUIRE(rpe.time_s.size() == 2);
  REQUIRE(rpe.time_s[0] == Approx(1.0));
  REQUIRE(rpe.time_s[1] == Approx(2.0));
}

TEST_CASE("alignment with scale changes the error, a motion does not") {
  const Trajectory truth = helix(40);
  Trajectory estimate = truth;
  for (Pose& pose : estimate.poses) pose.t *= 2.0;
  REQUIRE(compare(truth, estimate, {}).translation.mean > 0.05);
  REQUIRE(relative_pose_error(truth, estimate, Alignment::kSim3, 0.02, {}).translation.max < 1e-12);
  const double none = compare(truth, estimate, {}).translation.rmse;
  const double se3 =
      relative_pose_error(truth, estimate, Alignment::kSe3, 0.02, {}).translation.rmse;
  REQUIRE(se3 == Approx(none).epsilon(1e-9));
}

TEST_CASE("steps that cannot be taken are refused") {
  REQUIRE_THROWS_AS(compare(straight(3), straight(3), {5, StepUnit::kFrames, false}), InputError);
  REQUIRE_THROWS_AS(compare(straight(3), straight(3), {50, StepUnit::kMetres, true}), InputError);
  REQUIRE_THROWS_AS(compare(straight(3), straight(3), {1.5, StepUnit::kFrames, false}),
                    std::invalid_argument);
  REQUIRE_THROWS_AS(compare(straight(3), straight(3), {0, StepUnit::kMetres, false}),
                    std::invalid_argument);
  Trajectory kitti = straight(3);
  kitti.format = "kitti";
  REQUIRE_THROWS_AS(compare(kitti, kitti, {1, StepUnit::kSeconds, false}), InputError);
}
