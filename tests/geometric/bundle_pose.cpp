// SPDX-License-Identifier: MIT
// Pose of one camera from known points.
#include <limits>

#include "drivers/geometric/bundle/pose_solver.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::geometric;

namespace {

constexpr int kCamera = 6;

std::vector<PoseObservation> observations(const bundle_scene::Scene& scene) {
  std::vector<PoseObservation> list;
  for (const bundle_scene::Observation& seen : scene.observations) {
    if (seen.camera != kCamera) continue;
    list.push_back({scene.points[static_cast<std::size_t>(seen.point)],
                    scene.model.undistort(seen.pixel), 1.0});
  }
  return list;
}

CameraPose off(const CameraPose& pose) {
  Eigen::Matrix<double, 6, 1> step;
  step << 0.08, -0.05, 0.06, 0.03, -0.05, 0.02;
  return retract(pose, step);
}

PoseResult solve(const bundle_scene::Scene& scene, const std::vector<PoseObservation>& list,
                 const CameraPose& start, std::uint8_t* inlier) {
  PoseOptions options;
  options.max_iterations = 40;
  options.relative_tolerance = 1e-9;
  return solve_pose(scene.model, start, list.data(), static_cast<int>(list.size()), options,
                    inlier);
}

}  // namespace

TEST_CASE("pose is exact on exact observations") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  const std::vector<PoseObservation> list = observations(scene);
  const PoseResult result = solve(scene, list, off(scene.poses[kCamera]), nullptr);
  REQUIRE(result.status == PoseStatus::kOk);
  REQUIRE(result.inliers == static_cast<int>(list.size()));
  REQUIRE((result.pose.R - scene.poses[kCamera].R).norm() < 1e-8);
  REQUIRE((result.pose.t - scene.poses[kCamera].t).norm() < 1e-8);
}

TEST_CASE("pose withstands a third of outliers and names them") {
  bundle_scene::Options options;
  options.noise_px = 0.2;
  const bundle_scene::Scene scene = bundle_scene::make(options);
  std::vector<PoseObservation> list = observations(scene);
  for (std::size_t i = 0; i < list.size(); i += 3) {
    list[i].undistorted_px += Eigen::Vector2d(40.0, i % 2 == 0 ? -35.0 : 35.0);
  }
  std::vector<std::uint8_t> inlier(list.size(), 2);
  const PoseResult result = solve(scene, list, off(scene.poses[kCamera]), inlier.data());
  for (std::size_t i = 0; i < list.size(); ++i) REQUIRE(inlier[i] == (i % 3 == 0 ? 0 : 1));
  REQUIRE((result.pose.center() - scene.poses[kCamera].center()).norm() < 2e-3);
}

TEST_CASE("observations of weight zero have no say") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  std::vector<PoseObservation> list = observations(scene);
  for (std::size_t i = 0; i < list.size(); i += 2) {
    list[i].undistorted_px.x() += 4.0;
    list[i].weight = 0.0;
  }
  const PoseResult result = solve(scene, list, off(scene.poses[kCamera]), nullptr);
  REQUIRE(result.cost < 1e-12);
  REQUIRE(result.inliers == static_cast<int>(list.size() / 2));
}

TEST_CASE("pose information predicts the cost of a small step") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  const std::vector<PoseObservation> list = observations(scene);
  const PoseResult best = solve(scene, list, scene.poses[kCamera], nullptr);
  Eigen::Matrix<double, 6, 1> step;
  step << 1e-5, -2e-5, 1e-5, 1e-5, 2e-5, -1e-5;
  PoseOptions options;
  options.max_iterations = 0;
  const PoseResult moved = solve_pose(scene.model, retract(best.pose, step), list.data(),
                                      static_cast<int>(list.size()), options, nullptr);
  REQUIRE(moved.cost == Approx(0.5 * step.dot(best.information * step)).epsilon(1e-2));
}

TEST_CASE("a pose that cannot be solved is the start") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  std::vector<PoseObservation> list = observations(scene);
  const CameraPose start = off(scene.poses[kCamera]);
  SECTION("too few") { list.resize(2); }
  SECTION("all behind") {
    for (PoseObservation& seen : list) seen.point_world.z() = -50.0;
  }
  SECTION("not a number") { list[4].point_world.x() = std::numeric_limits<double>::quiet_NaN(); }
  const PoseResult result = solve(scene, list, start, nullptr);
  REQUIRE(result.status != PoseStatus::kOk);
  REQUIRE(result.pose.R == start.R);
  REQUIRE(result.pose.t == start.t);
}
