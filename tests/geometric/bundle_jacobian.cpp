// SPDX-License-Identifier: MIT
// Analytic Jacobians of the bundle factors against central differences.
#include "drivers/geometric/bundle/reprojection_residual.hpp"
#include "drivers/geometric/bundle/robust_cost.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::geometric;

namespace {

constexpr double kStep = 1e-6;
constexpr double kWeight = 0.7;
constexpr double kScale = 1.3;

struct State {
  CameraPose pose;
  Eigen::Vector3d point;
  BundleIntrinsics intrinsics;
  BundleObservation seen;
};

State random_state(std::mt19937* random) {
  State state;
  Eigen::Matrix<double, 6, 1> twist;
  twist << bundle_scene::uniform3(random), bundle_scene::uniform3(random);
  state.pose = retract(CameraPose(), twist);
  const Eigen::Vector3d r = bundle_scene::uniform3(random);
  const Eigen::Vector3d y(0.8 * r.x(), 0.6 * r.y(), 2.5 + r.z());
  state.point = state.pose.R.transpose() * (y - state.pose.t);
  state.intrinsics.log_focal = std::log(500.0);
  state.intrinsics.k1 = -0.05;
  state.intrinsics.cx = 319.5;
  state.intrinsics.cy = 239.5;
  state.intrinsics.readout_s = 0.02;
  state.seen.u = 320.0 + 300.0 * bundle_scene::uniform(random);
  state.seen.v = 240.0 + 200.0 * bundle_scene::uniform(random);
  state.seen.weight = kWeight;
  state.seen.sway = {400.0 * bundle_scene::uniform(random), 300.0 * bundle_scene::uniform(random)};
  return state;
}

// Unknown 0-5 camera, 6-8 point, 9 log f, 10 k1, 11 cx, 12 cy, 13 readout.
State moved(const State& from, int unknown, double h) {
  State to = from;
  if (unknown < 6) {
    to.pose = retract(from.pose, h * Eigen::Matrix<double, 6, 1>::Unit(unknown));
  } else if (unknown < 9) {
    to.point[unknown - 6] += h;
  } else if (unknown == 9) {
    to.intrinsics.log_focal += h;
  } else if (unknown == 10) {
    to.intrinsics.k1 += h;
  } else if (unknown == 13) {
    to.intrinsics.readout_s += h;
  } else {
    (unknown == 11 ? to.intrinsics.cx : to.intrinsics.cy) += h;
  }
  return to;
}

Eigen::Vector2d reprojection(const State& s) {
  return reprojection_value(residual_intrinsics(s.intrinsics, kScale), s.pose.apply(s.point),
                            s.seen);
}

}  // namespace

TEST_CASE("reprojection Jacobians agree with central differences") {
  std::mt19937 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const State s = random_state(&random);
    ReprojectionResidual J;
    reprojection_jacobian(residual_intrinsics(s.intrinsics, kScale), s.pose.R,
                          s.pose.apply(s.point), s.seen, kWeight, &J);
    Eigen::Matrix<double, 2, 14> analytic;
    analytic.row(0) << J.camera0.transpose(), J.point0.transpose(), J.intrinsics0.transpose();
    analytic.row(1) << J.camera1.transpose(), J.point1.transpose(), J.intrinsics1.transpose();
    for (int k = 0; k < 14; ++k) {
      const Eigen::Vector2d numeric =
          (reprojection(moved(s, k, kStep)) - reprojection(moved(s, k, -kStep))) / (2.0 * kStep);
      INFO("unknown " << k);
      REQUIRE((numeric - analytic.col(k)).norm() < 1e-5 * (1.0 + numeric.norm()));
    }
  }
}

TEST_CASE("Huber weight is the slope of the Huber cost over the norm") {
  for (const double norm : {0.2, 0.99, 1.01, 7.0}) {
    const double slope =
        (huber_cost(norm + kStep, 1.0) - huber_cost(norm - kStep, 1.0)) / (2.0 * kStep);
    REQUIRE(huber_weight(norm, 1.0) * norm == Approx(slope).epsilon(1e-6));
  }
}
