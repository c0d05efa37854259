// SPDX-License-Identifier: MIT
// The simulated world: exact where it has no noise, the same for the same seed.
#include <set>

#include "tests/support/catch.hpp"
#include "tools/bench/simulator/predictor.hpp"

using namespace unisim::simulator;

namespace {

NoiseModel exact() {
  NoiseModel model;
  model.scale = 0.0;
  model.pair_view = 0.0;
  model.tilt = 0.0;
  model.pixel = 0.0;
  model.outlier_share = 0.0;
  return model;
}

double angle_between(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  return Eigen::AngleAxisd(A.transpose() * B).angle();
}

// Unit of an inference: its depth over the true depth, the same in all pixels without noise.
double unit_of(const World& world, const Prediction& prediction, size_t view) {
  const DepthMap& truth = world.depth[static_cast<size_t>(prediction.keyframes[view])];
  const double unit = prediction.depth[view][0] / truth[0];
  for (size_t pixel = 0; pixel < truth.size(); ++pixel) {
    REQUIRE(prediction.depth[view][pixel] / truth[pixel] == Approx(unit).epsilon(1e-5));
  }
  return unit;
}

void require_exact(const World& world, const Prediction& prediction, size_t frame) {
  const double unit = unit_of(world, prediction, 0);
  const RigidPose T_frame_world =
      world.T_world_kf[static_cast<size_t>(prediction.keyframes[frame])].inverse();
  const RigidPose gauge = prediction.T_local_kf[frame];
  for (size_t k = 0; k < prediction.keyframes.size(); ++k) {
    CHECK(unit_of(world, prediction, k) == Approx(unit).epsilon(1e-5));
    const RigidPose truth =
        T_frame_world * world.T_world_kf[static_cast<size_t>(prediction.keyframes[k])];
    const RigidPose seen = gauge.inverse() * prediction.T_local_kf[k];
    CHECK((seen.t - unit * truth.t).norm() < 1e-6);
    CHECK(angle_between(seen.R, truth.R) < 1e-6);
  }
}

}  // namespace

TEST_CASE("without noise pairs, windows and loops are exact in one unit each") {
  const World world = make_world(WorldKind::kWalk, 600, 3);
  const Predictor predictor(world, 3, exact());
  require_exact(world, predictor.pair(7), 0);
  require_exact(world, predictor.window(28, 16), 8);
  const std::vector<Loop> loops = find_loops(world);
  REQUIRE_FALSE(loops.empty());
  require_exact(world, predictor.loop(loops.front()), kLoopHalf);
  CHECK(unit_of(world, predictor.pair(7), 0) != Approx(unit_of(world, predictor.pair(8), 0)));
}

TEST_CASE("noise is there and of the stated size") {
  const World world = make_world(WorldKind::kScan, 200, 5);
  const Predictor predictor(world, 5);
  double squared = 0.0;
  for (int32_t i = 0; i + 1 < world.keyframes(); ++i) {
    const size_t at = static_cast<size_t>(i);
    const RigidPose truth = world.T_world_kf[at].inverse() * world.T_world_kf[at + 1];
    squared += std::pow(angle_between(predictor.pair(i).T_local_kf[1].R, truth.R), 2);
  }
  const double sigma = std::sqrt(squared / 199.0 / 3.0) * 57.29577951308232;
  CHECK(sigma == Approx(0.18).epsilon(0.15));  // degrees per axis
}

TEST_CASE("a prediction depends on seed and item alone") {
  const World world = make_world(WorldKind::kRoom, 100, 2);
  const Predictor one(world, 2);
  const Predictor other(world, 2);
  const Prediction first = one.window(14, 16);
  other.pair(3);
  const Prediction again = other.window(14, 16);
  CHECK(first.depth == again.depth);
  for (size_t k = 0; k < 16; ++k) CHECK(first.T_local_kf[k].t == again.T_local_kf[k].t);
  CHECK(Predictor(world, 4).window(14, 16).depth != first.depth);
}

TEST_CASE("the camera stays in the room and sees surfaces in front of it") {
  const World world = make_world(WorldKind::kScan, 300, 9);
  for (const RigidPose& pose : world.T_world_kf) {
    CHECK(pose.t.cwiseAbs().maxCoeff() < 3.0);
    CHECK((pose.R.transpose() * pose.R).isIdentity(1e-9));
    CHECK(pose.R.determinant() == Approx(1.0));
  }
  for (const DepthMap& depth : world.depth) {
    for (const float d : depth) {
      CHECK(d >= 0.15F);
      CHECK(d < 12.0F);
    }
  }
}

TEST_CASE("loops join views of one place, false loops do not") {
  const World world = make_world(WorldKind::kWalk, 1000, 1);
  const std::vector<Loop> loops = find_loops(world);
  CHECK(loops.size() > 20);
  std::set<int32_t> blocks;
  for (const Loop& loop : loops) {
    CHECK(loop.query - loop.match > 60);
    const RigidPose& query = world.T_world_kf[static_cast<size_t>(loop.query)];
    const RigidPose& match = world.T_world_kf[static_cast<size_t>(loop.match)];
    CHECK((query.t - match.t).norm() < 0.35);
    CHECK(query.R.col(2).dot(match.R.col(2)) > std::cos(30.0 / 57.29577951308232));
    CHECK(blocks.insert(loop.query / 14).second);
  }
  const std::vector<Loop> mixed = with_false_loops(world, loops, 0.1, 1);
  const auto wrong =
      std::count_if(mixed.begin(), mixed.end(), [](const Loop& l) { return l.is_false; });
  CHECK(static_cast<double>(wrong) / static_cast<double>(mixed.size()) == Approx(0.1).margin(0.02));
  CHECK(std::is_sorted(mixed.begin(), mixed.end(),
                       [](const Loop& a, const Loop& b) { return a.query < b.query; }));
}

TEST_CASE("a false loop puts its two places together") {
  const World world = make_world(WorldKind::kWalk, 400, 6);
  const Predictor predictor(world, 6);
  const Loop loop{300, 100, true};
  REQUIRE((world.T_world_kf[300].t - world.T_world_kf[100].t).norm() > 1.0);
  const Prediction prediction = predictor.loop(loop);
  REQUIRE(prediction.keyframes.size() == 16);
  CHECK(std::is_sorted(prediction.keyframes.begin(), prediction.keyframes.end()));
  const double unit = prediction.depth[12][0] / world.depth[300][0];
  const Eigen::Vector3d apart = prediction.T_local_kf[4].t - prediction.T_local_kf[12].t;
  CHECK(apart.norm() / unit < 0.8);
}
