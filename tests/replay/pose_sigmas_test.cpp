// SPDX-License-Identifier: MIT
// Standard deviations after an alignment, against the joint covariance put through that alignment
// by finite differences.
#include "tools/replay/pose_sigmas.hpp"

#include <Eigen/Dense>
#include <memory>

#include "tests/support/catch.hpp"
#include "tools/eval/alignment.hpp"

using namespace unisim::replay;

namespace {

constexpr int kKeyframes = 7;

/// A chain of pairs over a bent path that turns and changes its scale.
class Chain {
 public:
  explicit Chain(double bend) {
    unisim_config config;
    REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
    config.max_keyframes = 32;
    size_t bytes = 0;
    REQUIRE(unisim_arena_size(&config, &bytes) == UNISIM_OK);
    arena_ = std::make_unique<unsigned char[]>(bytes);
    REQUIRE(unisim_session_create(&session_, &config, arena_.get(), bytes) == UNISIM_OK);
    for (int k = 0; k < kKeyframes; ++k) {
      const unisim_keyframe keyframe = {sizeof keyframe, 0, k * INT64_C(100000000)};
      int32_t id = 0;
      REQUIRE(unisim_add_keyframe(session_, &keyframe, &id) == UNISIM_OK);
      if (k > 0) add_pair(k - 1, bend);
    }
    REQUIRE(unisim_optimize(session_, nullptr, nullptr) == UNISIM_OK);
    for (int k = 0; k < kKeyframes; ++k) {
      unisim_pose pose = {};
      pose.struct_size = sizeof pose;
      REQUIRE(unisim_get_pose(session_, k, &pose) == UNISIM_OK);
      poses_.push_back(pose);
    }
  }
  ~Chain() { unisim_session_destroy(session_); }
  Chain(const Chain&) = delete;
  Chain& operator=(const Chain&) = delete;

  unisim_session* session() const { return session_; }
  const std::vector<unisim_pose>& poses() const { return poses_; }

 private:
  void add_pair(int i, double bend) {
    const Eigen::AngleAxisd turn(bend * (0.2 + 0.1 * i),
                                 Eigen::Vector3d(0.2 * i, 1, 0.3).normalized());
    const Eigen::Quaterniond q(turn);
    unisim_two_view pair = {};
    pair.struct_size = sizeof pair;
    pair.i = i;
    pair.j = i + 1;
    pair.T_i_j = {{q.x(), q.y(), q.z(), q.w()}, {0.3, 0.1 * bend * i, 0.2 * bend}, 1.0};
    const std::vector<float> near(64, 1.0F);
    const std::vector<float> far(64, 1.0F + 0.1F * static_cast<float>(i));
    pair.depth_i = {near.data(), nullptr, 8, 8};
    pair.depth_j = {far.data(), nullptr, 8, 8};
    REQUIRE(unisim_add_two_view(session_, &pair) == UNISIM_OK);
  }

  std::unique_ptr<unsigned char[]> arena_;
  unisim_session* session_ = nullptr;
  std::vector<unisim_pose> poses_;
};

struct Camera {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
  double s;
};

Camera camera_of(const unisim_pose& pose) {
  const unisim_sim3& T = pose.T_world_kf;
  return {Eigen::Quaterniond(T.q[3], T.q[0], T.q[1], T.q[2]).toRotationMatrix(),
          {T.t[0], T.t[1], T.t[2]},
          T.s};
}

Eigen::Vector3d turn_of(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

/// Six numbers a pose: what an error leaves of position and turn after the alignment.
Eigen::VectorXd left_after_alignment(const std::vector<Camera>& truth, Eigen::VectorXd error) {
  std::vector<Eigen::Vector3d> from, to;
  std::vector<Eigen::Matrix3d> turned;
  for (int k = 0; k < kKeyframes; ++k) {
    const Camera& at = truth[static_cast<size_t>(k)];
    const Eigen::Vector3d turn = error.segment<3>(7 * k + 3);
    to.push_back(at.p);
    from.push_back(at.p + at.s * (at.R * error.segment<3>(7 * k)));
    turned.push_back(at.R *
                     Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix());
  }
  const unisim::eval::Similarity T = unisim::eval::align(from, to, unisim::eval::Alignment::kSim3);
  Eigen::VectorXd left(6 * kKeyframes);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int k = 0; k < kKeyframes; ++k) {
    const auto at = static_cast<size_t>(k);
    left.segment<3>(6 * k) = T * from[at] - to[at];
    left.segment<3>(6 * k + 3) = turn_of(truth[at].R.transpose() * T.R * turned[at]);
    mean += left.segment<3>(6 * k + 3) / kKeyframes;
  }
  for (int k = 0; k < kKeyframes; ++k) left.segment<3>(6 * k + 3) -= mean;
  return left;
}

}  // namespace

TEST_CASE("standard deviations are those that an alignment by least squares leaves") {
  const Chain chain(1.0);
  std::vector<Camera> cameras;
  for (const unisim_pose& pose : chain.poses()) cameras.push_back(camera_of(pose));
  constexpr int kSize = 7 * kKeyframes;
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd joint(kSize, kSize);
  Eigen::MatrixXd derivative(6 * kKeyframes, kSize);
  for (int k = 0; k < kSize; ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(kSize, k);
    REQUIRE(unisim_multiply_covariance(chain.session(), 0, kKeyframes, unit.data(),
                                       joint.col(k).data()) == UNISIM_OK);
    derivative.col(k) = (left_after_alignment(cameras, kStep * unit) -
                         left_after_alignment(cameras, -kStep * unit)) /
                        (2 * kStep);
  }
  const Eigen::MatrixXd left = derivative * joint * derivative.transpose();
  const std::vector<PoseSigma> sigmas = pose_sigmas(chain.session(), chain.poses());
  REQUIRE(sigmas.size() == kKeyframes);
  for (int k = 0; k < kKeyframes; ++k) {
    const PoseSigma& sigma = sigmas[static_cast<size_t>(k)];
    INFO(k);
    CHECK(sigma.position ==
          Approx(std::sqrt(left.block<3, 3>(6 * k, 6 * k).trace())).epsilon(1e-5));
    CHECK(sigma.rotation ==
          Approx(std::sqrt(left.block<3, 3>(6 * k + 3, 6 * k + 3).trace())).epsilon(1e-5));
  }
}

TEST_CASE("on a straight line positions have a standard deviation, of one place nothing has") {
  const Chain straight(0.0);
  for (const PoseSigma& sigma : pose_sigmas(straight.session(), straight.poses())) {
    CHECK(sigma.position > 0.0);
    CHECK(std::isfinite(sigma.position));
  }
  const std::vector<unisim_pose> two(straight.poses().begin(), straight.poses().begin() + 2);
  for (const PoseSigma& sigma : pose_sigmas(straight.session(), two)) CHECK(sigma.position < 0.0);
}
