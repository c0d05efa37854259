// SPDX-License-Identifier: MIT
// Paths are smooth, start slowly, come back, or stand still where they promise it.
#include "tools/synth/path.hpp"

#include "tests/support/catch.hpp"

namespace {

using namespace unisim::synth;

double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

double angle(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

}  // namespace

TEST_CASE("poses are rigid and steps between frames stay small") {
  const auto kind = GENERATE(SceneKind::kRoom, SceneKind::kCorridor, SceneKind::kDesk,
                             SceneKind::kRotation, SceneKind::kLowTexture, SceneKind::kStatic);
  const int loops = GENERATE(0, 1);
  const CameraPath path({kind, 20, loops, 5});
  for (int frame = 0; frame < 600; ++frame) {
    const Eigen::Isometry3d now = path.T_world_cam(frame / 30.0);
    const Eigen::Isometry3d next = path.T_world_cam((frame + 1) / 30.0);
    const Eigen::Matrix3d R = now.linear();
    REQUIRE((R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    REQUIRE(R.determinant() > 0);
    REQUIRE(distance(now, next) < 0.1);
    REQUIRE(angle(now, next) < 0.1);
  }
}

TEST_CASE("a round ends near its start and an open path does not") {
  const CameraPath round({SceneKind::kRoom, 20, 1, 5});
  const CameraPath open({SceneKind::kRoom, 20, 0, 5});
  const double start_of_round = 20 / 1.07;
  CHECK(distance(round.T_world_cam(0), round.T_world_cam(start_of_round)) < 0.4);
  CHECK(distance(open.T_world_cam(0), open.T_world_cam(20)) > 1);
}

TEST_CASE("two rounds see the same place twice") {
  const CameraPath path({SceneKind::kCorridor, 40, 2, 5});
  CHECK(distance(path.T_world_cam(8), path.T_world_cam(28)) < 1.0);
}

TEST_CASE("the rotation scene turns all around without moving") {
  const CameraPath path({SceneKind::kRotation, 10, 1, 5});
  double widest = 0;
  for (int frame = 1; frame < 300; ++frame) {
    REQUIRE(distance(path.T_world_cam(0), path.T_world_cam(frame / 30.0)) == 0);
    widest = std::max(widest, angle(path.T_world_cam(0), path.T_world_cam(frame / 30.0)));
  }
  CHECK(widest > 3);
}

TEST_CASE("the static scene does not move at all") {
  const CameraPath path({SceneKind::kStatic, 10, 1, 5});
  CHECK(path.T_world_cam(0).matrix() == path.T_world_cam(7.3).matrix());
}
