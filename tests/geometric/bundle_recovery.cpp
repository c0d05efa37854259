// SPDX-License-Identifier: MIT
// Bundle adjustment finds the truth of made-up scenes from a start that is off.
#include <cstring>

#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "drivers/geometric/bundle/world_move.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::geometric;

namespace {

BundleOptions thorough() {
  BundleOptions options;
  options.max_iterations = 40;
  options.relative_tolerance = 1e-10;
  return options;
}

// RMS distance of camera centres from the truth over the RMS spread, after the scale about the
// first camera is taken out. For problems whose first camera is held at its true pose.
double center_error(const bundle_scene::Scene& scene, const BundleProblem& problem) {
  double cross = 0.0;
  double square = 0.0;
  const Eigen::Vector3d origin = scene.poses[0].center();
  for (std::size_t i = 0; i < scene.poses.size(); ++i) {
    const Eigen::Vector3d found = problem.camera(static_cast<int>(i)).pose.center() - origin;
    cross += found.dot(scene.poses[i].center() - origin);
    square += found.squaredNorm();
  }
  double error = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < scene.poses.size(); ++i) {
    const Eigen::Vector3d found = problem.camera(static_cast<int>(i)).pose.center() - origin;
    const Eigen::Vector3d truth = scene.poses[i].center() - origin;
    error += (cross / square * found - truth).squaredNorm();
    spread += truth.squaredNorm();
  }
  return std::sqrt(error / spread);
}

// Unit of the solved scene against the truth.
double scale(const bundle_scene::Scene& scene, const BundleProblem& problem) {
  const int last = problem.camera_count() - 1;
  return (problem.camera(last).pose.center() - problem.camera(0).pose.center()).norm() /
         (scene.poses.back().center() - scene.poses.front().center()).norm();
}

}  // namespace

TEST_CASE("bundle adjustment recovers an exact scene") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  BundleProblem problem(bundle_scene::capacity(scene));
  BundleAdjuster adjuster(problem.capacity());
  const int fixed = GENERATE(1, 2, 5);
  const bool free_intrinsics = GENERATE(false, true);
  CAPTURE(fixed, free_intrinsics);
  bundle_scene::fill(scene, fixed, &problem);
  bundle_scene::perturb(0.02, 0.05, 0.1, 7, &problem);
  if (free_intrinsics) {
    problem.intrinsics.free_focal = true;
    problem.intrinsics.free_k1 = true;
    problem.intrinsics.log_focal += 0.15;
    problem.intrinsics.k1 = 0.02;
    problem.intrinsics.free_center = true;
    problem.intrinsics.cx += 9.0;
    problem.intrinsics.cy -= 6.0;
  }
  const BundleResult result = adjuster.solve(&problem, thorough());
  REQUIRE(result.initial_cost > 1e3);
  REQUIRE(result.final_cost < 1e-12);
  REQUIRE(result.observations == problem.observation_count());
  REQUIRE(center_error(scene, problem) < 1e-8);
  REQUIRE(std::exp(problem.intrinsics.log_focal) == Approx(525.0).epsilon(1e-8));
  REQUIRE(problem.intrinsics.k1 == Approx(-0.03).epsilon(1e-6));
  REQUIRE(problem.intrinsics.cx == Approx(319.5).epsilon(1e-7));
  REQUIRE(problem.intrinsics.cy == Approx(239.5).epsilon(1e-7));
  if (fixed > 1) REQUIRE(scale(scene, problem) == Approx(1.0).epsilon(1e-8));
  for (int i = 0; i < fixed; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    REQUIRE(problem.camera(i).pose.R == scene.poses[k].R);
    REQUIRE(problem.camera(i).pose.t == scene.poses[k].t);
  }
}

TEST_CASE("bundle adjustment finds how long the rows of an image take") {
  constexpr double kReadout = 0.025;
  const bundle_scene::Scene scene = bundle_scene::make({});
  BundleProblem problem(bundle_scene::capacity(scene));
  bundle_scene::fill(scene, 1, &problem);
  // Each camera sees its points in motion of its own; rows late by their share are off by it.
  std::mt19937 random(3);
  std::vector<Eigen::Vector2d> motion(scene.poses.size());
  for (Eigen::Vector2d& of_camera : motion) {
    of_camera = 400.0 * bundle_scene::uniform3(&random).head<2>();
  }
  for (int i = 0; i < problem.observation_count(); ++i) {
    BundleObservation& seen = problem.observation(i);
    seen.sway = (seen.v / 480.0 - 0.5) * motion[static_cast<std::size_t>(seen.camera)];
    seen.u += kReadout * seen.sway.x();
    seen.v += kReadout * seen.sway.y();
  }
  bundle_scene::perturb(0.02, 0.05, 0.1, 7, &problem);
  BundleAdjuster adjuster(problem.capacity());
  BundleProblem held = problem;
  adjuster.solve(&held, thorough());
  CHECK(center_error(scene, held) > 1e-3);
  problem.intrinsics.free_readout = true;
  const BundleResult result = adjuster.solve(&problem, thorough());
  CHECK(result.final_cost < 1e-12);
  CHECK(problem.intrinsics.readout_s == Approx(kReadout).epsilon(1e-7));
  CHECK(center_error(scene, problem) < 1e-8);
  const BundlePrecision precision = adjuster.precision(problem, thorough(), nullptr, 0);
  CHECK(precision.readout_sigma_s > 0.0);
  CHECK(precision.readout_sigma_s < 0.001);
}

// As when a loop closes at the end of a run: what only the first camera saw before pulls on it
// alone.
TEST_CASE("with no camera fixed the first one goes along when the others move far") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  BundleProblem problem(bundle_scene::capacity(scene));
  bundle_scene::fill(scene, 0, &problem);
  WorldMove away;
  away.R = rotation_exp(Eigen::Vector3d(0.1, 0.9, -0.2));
  away.t = Eigen::Vector3d(0.6, -0.3, 0.8);
  away.scale = 0.7;
  for (int i = 1; i < problem.camera_count(); ++i) {
    problem.camera(i).pose = away.apply(problem.camera(i).pose);
  }
  for (int i = 0; i < problem.point_count(); ++i) {
    problem.point(i).position = away.apply(problem.point(i).position);
  }
  BundleAdjuster adjuster(problem.capacity());
  BundleOptions options = thorough();
  options.huber = 1.0;
  const BundleResult result = adjuster.solve(&problem, options);
  CHECK(result.final_cost < 1e-6);
  CHECK(problem.camera(0).pose.t == scene.poses[0].t);
}

TEST_CASE("with no camera fixed the first stays where it was and the unit of the start survives") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  BundleProblem problem(bundle_scene::capacity(scene));
  bundle_scene::fill(scene, 0, &problem);
  bundle_scene::perturb(0.01, 0.02, 0.05, 9, &problem);
  const CameraPose first = problem.camera(0).pose;
  BundleAdjuster adjuster(problem.capacity());
  const BundleResult result = adjuster.solve(&problem, thorough());
  REQUIRE(result.final_cost < 1e-12);
  REQUIRE(problem.camera(0).pose.R == first.R);
  REQUIRE(problem.camera(0).pose.t == first.t);
  REQUIRE(scale(scene, problem) == Approx(1.0).epsilon(0.05));
}

TEST_CASE("Huber keeps outliers from bending the result") {
  bundle_scene::Options clean;
  clean.noise_px = 0.3;
  bundle_scene::Options dirty = clean;
  dirty.outlier_share = 0.08;
  double error[2] = {0.0, 0.0};
  double square_loss_error = 0.0;
  for (int i = 0; i < 2; ++i) {
    const bundle_scene::Scene scene = bundle_scene::make(i == 0 ? clean : dirty);
    BundleProblem problem(bundle_scene::capacity(scene));
    BundleAdjuster adjuster(problem.capacity());
    BundleOptions options = thorough();
    bundle_scene::fill(scene, 1, &problem);
    bundle_scene::perturb(0.01, 0.03, 0.05, 5, &problem);
    adjuster.solve(&problem, options);
    error[i] = center_error(scene, problem);
    options.huber = 1e6;
    bundle_scene::fill(scene, 1, &problem);
    adjuster.solve(&problem, options);
    square_loss_error = center_error(scene, problem);
  }
  REQUIRE(error[0] < 2e-3);
  REQUIRE(error[1] < 4e-3);
  REQUIRE(square_loss_error > 5.0 * error[1]);
}

TEST_CASE("a prior on the focal length decides where the data do not") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  BundleProblem problem(bundle_scene::capacity(scene));
  BundleAdjuster adjuster(problem.capacity());
  bundle_scene::fill(scene, 1, &problem);
  problem.intrinsics.free_focal = true;
  problem.intrinsics.log_focal_mean = std::log(600.0);
  problem.intrinsics.log_focal_sigma = 1e-7;
  adjuster.solve(&problem, thorough());
  REQUIRE(std::exp(problem.intrinsics.log_focal) == Approx(600.0).epsilon(1e-3));
  REQUIRE(problem.intrinsics.k1 == scene.model.k1);
}

TEST_CASE("the same problem gives the same bytes, whatever was solved before") {
  bundle_scene::Options options;
  options.noise_px = 0.5;
  options.outlier_share = 0.02;
  const bundle_scene::Scene scene = bundle_scene::make(options);
  options.cameras = 9;
  options.seed = 4;
  const bundle_scene::Scene other = bundle_scene::make(options);
  BundleProblem problem(bundle_scene::capacity(scene));
  BundleAdjuster used(problem.capacity());
  BundleAdjuster fresh(problem.capacity());
  bundle_scene::fill(other, 1, &problem);
  used.solve(&problem, thorough());
  std::vector<Eigen::Matrix3d> found[2];
  BundleAdjuster* adjusters[2] = {&used, &fresh};
  for (int i = 0; i < 2; ++i) {
    bundle_scene::fill(scene, 1, &problem);
    bundle_scene::perturb(0.01, 0.03, 0.05, 5, &problem);
    adjusters[i]->solve(&problem, thorough());
    for (int k = 0; k < problem.camera_count(); ++k) found[i].push_back(problem.camera(k).pose.R);
  }
  for (std::size_t k = 0; k < found[0].size(); ++k) {
    REQUIRE(std::memcmp(found[0][k].data(), found[1][k].data(), 9 * sizeof(double)) == 0);
  }
}
