// SPDX-License-Identifier: MIT
// Poses between the poses of a trajectory.
#include "tools/eval/interpolation.hpp"

#include "tests/eval/trajectories.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::eval;

namespace {

Trajectory asked_at(const std::vector<double>& times) {
  Trajectory asked = at_positions(std::vector<Eigen::Vector3d>(times.size(), {0, 0, 0}));
  for (size_t k = 0; k < times.size(); ++k) asked.poses[k].time_s = times[k];
  return asked;
}

}  // namespace

TEST_CASE("positions go straight and turns evenly from pose to pose") {
  Trajectory trajectory = at_positions({{0, 0, 0}, {4, 2, 0}});
  trajectory.poses[1].R = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Trajectory out = interpolate(trajectory, asked_at({0.25, 1.0}), 1.0);
  REQUIRE(out.poses.size() == 2);
  REQUIRE(out.poses[0].time_s == 0.25);
  REQUIRE((out.poses[0].t - Eigen::Vector3d(1, 0.5, 0)).norm() < 1e-12);
  REQUIRE(Eigen::AngleAxisd(out.poses[0].R).angle() == Approx(0.25));
  REQUIRE(out.poses[1].t == trajectory.poses[1].t);
}

TEST_CASE("nothing is made up outside of the trajectory or across a gap") {
  Trajectory trajectory = at_positions({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}});
  trajectory.poses[2].time_s = 5;
  const Trajectory out = interpolate(trajectory, asked_at({-1, 0.5, 3, 5, 6}), 2.0);
  REQUIRE(out.poses.size() == 2);
  REQUIRE(out.poses[0].time_s == 0.5);
  REQUIRE(out.poses[1].time_s == 5.0);
}

TEST_CASE("the median step is that of the times") {
  REQUIRE(median_step_s(asked_at({0, 1, 2, 12})) == 1.0);
  REQUIRE(median_step_s(asked_at({3})) == 0.0);
}
