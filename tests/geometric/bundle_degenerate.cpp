// SPDX-License-Identifier: MIT
// Bundle adjustment on input that cannot be solved: a status, and the state as it was.
#include <limits>

#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::geometric;

namespace {

bool same_state(const BundleProblem& a, const BundleProblem& b) {
  for (int i = 0; i < a.camera_count(); ++i) {
    if (a.camera(i).pose.R != b.camera(i).pose.R || a.camera(i).pose.t != b.camera(i).pose.t) {
      return false;
    }
  }
  for (int i = 0; i < a.point_count(); ++i) {
    if (a.point(i).position != b.point(i).position) return false;
  }
  return a.intrinsics.log_focal == b.intrinsics.log_focal && a.intrinsics.k1 == b.intrinsics.k1;
}

BundleProblem disturbed_problem() {
  const bundle_scene::Scene scene = bundle_scene::make({});
  BundleProblem problem(bundle_scene::capacity(scene));
  bundle_scene::fill(scene, 1, &problem);
  bundle_scene::perturb(0.01, 0.03, 0.05, 5, &problem);
  return problem;
}

BundleStatus solve_copy(const BundleProblem& start, const BundleOptions& options, bool* unchanged) {
  BundleProblem problem = start;
  BundleAdjuster adjuster(start.capacity());
  const BundleStatus status = adjuster.solve(&problem, options).status;
  *unchanged = same_state(problem, start);
  return status;
}

}  // namespace

TEST_CASE("a problem without observations is left alone") {
  BundleProblem problem({4, 4, 10, 10});
  problem.add_camera(CameraPose(), false);
  problem.add_camera(CameraPose(), false);
  problem.add_point(Eigen::Vector3d(0.0, 0.0, 2.0));
  bool unchanged = false;
  REQUIRE(solve_copy(problem, BundleOptions(), &unchanged) == BundleStatus::kNothingToDo);
  REQUIRE(unchanged);
}

TEST_CASE("an empty problem is left alone") {
  bool unchanged = false;
  REQUIRE(solve_copy(BundleProblem({4, 4, 10, 10}), BundleOptions(), &unchanged) ==
          BundleStatus::kNothingToDo);
}

TEST_CASE("points all behind their cameras are left alone") {
  BundleProblem problem = disturbed_problem();
  for (int p = 0; p < problem.point_count(); ++p) problem.point(p).position.z() = -50.0;
  bool unchanged = false;
  REQUIRE(solve_copy(problem, BundleOptions(), &unchanged) == BundleStatus::kNothingToDo);
  REQUIRE(unchanged);
}

TEST_CASE("a point behind every camera does not disturb the others") {
  BundleProblem problem = disturbed_problem();
  problem.point(3).position.z() = -50.0;
  BundleAdjuster adjuster(problem.capacity());
  const Eigen::Vector3d lost = problem.point(3).position;
  BundleOptions options;
  options.max_iterations = 30;
  const BundleResult result = adjuster.solve(&problem, options);
  REQUIRE(result.observations == problem.observation_count() - problem.point(3).count);
  REQUIRE(problem.point(3).position == lost);
  REQUIRE(problem.reprojection_error_px(problem.point(5), problem.point(5).first) < 1e-3);
}

TEST_CASE("numbers that are not finite are refused") {
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  const int where = GENERATE(0, 1, 2, 3, 4);
  CAPTURE(bad, where);
  const BundleProblem start = disturbed_problem();
  BundleProblem problem = start;
  if (where == 0) problem.observation(7).u = bad;
  if (where == 1) problem.observation(7).weight = bad;
  if (where == 2) problem.camera(2).pose.t.y() = bad;
  if (where == 3) problem.point(9).position.x() = bad;
  if (where == 4) problem.intrinsics.k1 = bad;
  BundleAdjuster adjuster(problem.capacity());
  REQUIRE(adjuster.solve(&problem, BundleOptions()).status == BundleStatus::kInvalidInput);
  for (int i = 0; i < problem.camera_count(); ++i) {
    REQUIRE(problem.camera(i).pose.R == start.camera(i).pose.R);
  }
}

TEST_CASE("options out of range are refused") {
  const BundleProblem problem = disturbed_problem();
  const int which = GENERATE(0, 1, 2);
  BundleOptions options;
  if (which == 0) options.huber = 0.0;
  if (which == 1) options.pixel_scale = -1.0;
  if (which == 2) options.max_iterations = -1;
  bool unchanged = false;
  REQUIRE(solve_copy(problem, options, &unchanged) == BundleStatus::kInvalidInput);
  REQUIRE(unchanged);
}

TEST_CASE("a problem larger than the adjuster is refused") {
  BundleProblem problem = disturbed_problem();
  BundleCapacity small = problem.capacity();
  small.observations = problem.observation_count() - 1;
  BundleAdjuster adjuster(small);
  REQUIRE(adjuster.solve(&problem, BundleOptions()).status == BundleStatus::kTooLarge);
}

TEST_CASE("a problem at its minimum stays there") {
  BundleProblem problem = disturbed_problem();
  BundleAdjuster adjuster(problem.capacity());
  BundleOptions options;
  options.max_iterations = 50;
  options.relative_tolerance = 1e-12;
  const double first = adjuster.solve(&problem, options).final_cost;
  const BundleResult again = adjuster.solve(&problem, options);
  REQUIRE(again.final_cost <= first);
  REQUIRE(std::isfinite(again.final_cost));
}

TEST_CASE("a camera without observations keeps its pose") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  BundleCapacity capacity = bundle_scene::capacity(scene);
  ++capacity.cameras;
  ++capacity.free_cameras;
  BundleProblem problem(capacity);
  bundle_scene::fill(scene, 1, &problem);
  bundle_scene::perturb(0.01, 0.03, 0.05, 5, &problem);
  const int idle = problem.add_camera(scene.poses[3], false);
  BundleAdjuster adjuster(capacity);
  REQUIRE(adjuster.solve(&problem, BundleOptions()).final_cost < 1.0);
  REQUIRE((problem.camera(idle).pose.t - scene.poses[3].t).norm() < 1e-12);
}

TEST_CASE("a problem refuses what would break its order or capacity") {
  BundleProblem problem({2, 1, 1, 2});
  REQUIRE_FALSE(problem.add_observation(0, 1.0, 1.0, 1.0));
  REQUIRE(problem.add_camera(CameraPose(), false) == 0);
  REQUIRE(problem.add_camera(CameraPose(), false) == -1);
  REQUIRE(problem.add_camera(CameraPose(), true) == 1);
  REQUIRE(problem.add_camera(CameraPose(), true) == -1);
  REQUIRE(problem.add_point(Eigen::Vector3d::Zero()) == 0);
  REQUIRE(problem.add_point(Eigen::Vector3d::Zero()) == -1);
  REQUIRE(problem.add_observation(1, 1.0, 1.0, 1.0));
  REQUIRE_FALSE(problem.add_observation(1, 1.0, 1.0, 1.0));
  REQUIRE_FALSE(problem.add_observation(0, 1.0, 1.0, 1.0));
  REQUIRE_FALSE(problem.add_observation(2, 1.0, 1.0, 1.0));
  problem.drop_point();
  REQUIRE(problem.point_count() == 0);
  REQUIRE(problem.observation_count() == 0);
}
