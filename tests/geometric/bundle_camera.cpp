// SPDX-License-Identifier: MIT
// The camera model of the bundle folder.
#include "drivers/geometric/bundle/camera_model.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::geometric;

namespace {

CameraModel model(double k1) {
  CameraModel camera;
  camera.focal_px = 500.0;
  camera.k1 = k1;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

}  // namespace

TEST_CASE("undistort follows undistorted = distorted (1 + k1 r^2)") {
  // 250 px off centre is r = 0.5, so the stretch is 1 + 0.04 * 0.25 = 1.01.
  const Eigen::Vector2d undistorted = model(0.04).undistort(Eigen::Vector2d(319.5 + 250.0, 239.5));
  REQUIRE(undistorted.x() == Approx(319.5 + 252.5));
  REQUIRE(undistorted.y() == Approx(239.5));
}

TEST_CASE("distort undoes undistort over the image") {
  for (const double k1 : {-0.1, 0.0, 0.1}) {
    for (double u = 0.0; u < 640.0; u += 71.0) {
      for (double v = 0.0; v < 480.0; v += 59.0) {
        const CameraModel camera = model(k1);
        Eigen::Vector2d back;
        REQUIRE(camera.distort(camera.undistort(Eigen::Vector2d(u, v)), &back));
        REQUIRE((back - Eigen::Vector2d(u, v)).norm() < 1e-9);
      }
    }
  }
}

TEST_CASE("distort refuses what the model folds over") {
  Eigen::Vector2d pixel(1.0, 2.0);
  REQUIRE_FALSE(model(-0.3).distort(Eigen::Vector2d(5000.0, 239.5), &pixel));
  REQUIRE(pixel == Eigen::Vector2d(1.0, 2.0));
}

TEST_CASE("project is the inverse of normalize") {
  const CameraModel camera = model(-0.05);
  Eigen::Vector2d pixel;
  REQUIRE(camera.project(Eigen::Vector3d(0.4, -0.3, 2.0), &pixel));
  const Eigen::Vector2d ray = camera.normalize(pixel);
  REQUIRE(ray.x() == Approx(0.2));
  REQUIRE(ray.y() == Approx(-0.15));
}

TEST_CASE("project refuses points at and behind the camera") {
  Eigen::Vector2d pixel(1.0, 2.0);
  REQUIRE_FALSE(model(0.0).project(Eigen::Vector3d(0.1, 0.1, 0.0), &pixel));
  REQUIRE_FALSE(model(0.0).project(Eigen::Vector3d(0.1, 0.1, -1.0), &pixel));
  REQUIRE(pixel == Eigen::Vector2d(1.0, 2.0));
}

TEST_CASE("rotation_exp agrees with itself on both sides of its series") {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  const Eigen::Matrix3d small = rotation_exp(0.99999e-4 * axis);
  const Eigen::Matrix3d large = rotation_exp(1.00001e-4 * axis);
  REQUIRE((large - small).norm() < 4e-9);
  REQUIRE((small * small.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-14);
}

TEST_CASE("retract keeps the rotation orthonormal over many steps") {
  CameraPose pose;
  Eigen::Matrix<double, 6, 1> step;
  step << 0.01, 0.0, -0.01, 0.3, -0.2, 0.1;
  for (int i = 0; i < 2000; ++i) pose = retract(pose, step);
  REQUIRE((pose.R * pose.R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-14);
}
