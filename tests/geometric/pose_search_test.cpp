// SPDX-License-Identifier: MIT
// A pose from points of which most are wrong.
#include "drivers/geometric/places/pose_search.hpp"

#include <random>

#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

constexpr double kGate = 4.0;

double between(std::mt19937* random, double least, double most) {
  return least + (most - least) * static_cast<double>((*random)()) / 4294967296.0;
}

/// `right` points where a camera at `pose` sees them, then `wrong` ones anywhere.
std::vector<PoseObservation> points(const CameraModel& camera, const CameraPose& pose, int right,
                                    int wrong, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<PoseObservation> out;
  while (static_cast<int>(out.size()) < right + wrong) {
    const Eigen::Vector3d point(between(&random, -2, 2), between(&random, -2, 2),
                                between(&random, 2, 6));
    Eigen::Vector2d pixel(between(&random, 0, 640), between(&random, 0, 480));
    const bool is_right = static_cast<int>(out.size()) < right;
    if (is_right && !camera.project_undistorted(pose.apply(point), &pixel)) continue;
    out.push_back({point, pixel, 1.0});
  }
  // Where the right ones stand does not matter but for the time.
  for (size_t k = 0; k < out.size(); ++k) std::swap(out[k], out[random() % out.size()]);
  return out;
}

}  // namespace

TEST_CASE("a pose is found among points of which two thirds are wrong") {
  const auto seed = GENERATE(1U, 2U, 3U, 4U, 5U);
  CameraModel camera;
  camera.focal_px = 525;
  camera.cx = 320;
  camera.cy = 240;
  CameraPose truth;
  truth.R = rotation_exp({0.2, -0.4, 0.1});
  truth.t = {0.3, -0.2, 0.5};
  const std::vector<PoseObservation> seen = points(camera, truth, 14, 28, seed);
  CameraPose found;
  const int agree = search_pose(camera, seen, kGate, &found);
  CHECK(agree >= 14);
  CHECK((found.center() - truth.center()).norm() < 0.01);
  CameraPose again;
  CHECK(search_pose(camera, seen, kGate, &again) == agree);
  CHECK(again.t == found.t);
}

TEST_CASE("few points or points without a pose in common give none worth having") {
  CameraModel camera;
  camera.focal_px = 525;
  camera.cx = 320;
  camera.cy = 240;
  CameraPose pose;
  CHECK(search_pose(camera, points(camera, {}, 5, 0, 1), kGate, &pose) == 0);
  CHECK(search_pose(camera, points(camera, {}, 0, 48, 1), kGate, &pose) < 8);
}

}  // namespace unisim::geometric::test
