// SPDX-License-Identifier: MIT
// Tracks that have drifted off their points are put back onto them.
#include "drivers/geometric/map/remeasure.hpp"

#include "drivers/geometric/map/capacities.hpp"
#include "tests/geometric/predictor_run.hpp"
#include "tests/geometric/prepared_view.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

constexpr float kDrift = 0.8F;  // pixels

/// Two keyframes of the room, landmarks on a grid in the first with their patches, and tracks near
/// where the second sees them.
class Drifted {
 public:
  explicit Drifted(const CameraPlace& second)
      : config_(default_config()),
        state_(config_, map_capacity(config_)),
        patches_(config_.max_landmarks) {
    state_.size = cv::Size(kWidth, kHeight);
    state_.intrinsics = Intrinsics::start(state_.size, kFocal);
    atlas_.open(state_.size);
    remeasure_.reserve(1000);
    prepare_view(CameraPlace(), &first_);
    prepare_view(second, &second_);
    state_.map.push_keyframe(0, 0).posed = true;
    pose_.R = second.R.transpose();
    pose_.t = -pose_.R * second.center;
    for (int y = 40; y < kHeight - 40; y += 20) {
      for (int x = 40; x < kWidth - 40; x += 20) add(x, y);
    }
  }

  int run() { return remeasure_.run(patches_, second_, pose_, &state_); }
  /// Mean distance of the tracks from where the second keyframe sees their landmarks.
  double error() const {
    double sum = 0;
    for (size_t i = 0; i < truth_.size(); ++i) {
      sum += cv::norm(state_.tracks.point[i] - truth_[i]);
    }
    return sum / static_cast<double>(truth_.size());
  }
  size_t tracks() const { return truth_.size(); }
  State& state() { return state_; }

 private:
  /// The wall ahead is at z = 3.
  void add(int x, int y) {
    const cv::Point2f at(static_cast<float>(x), static_cast<float>(y));
    const Eigen::Vector2d ray = state_.intrinsics.camera.normalize({x, y});
    const int32_t slot = state_.map.add_landmark(0);
    Landmark& mark = state_.map.landmark(slot);
    mark.position = Eigen::Vector3d(3 * ray.x(), 3 * ray.y(), 3);
    Eigen::Vector2d seen;
    if (!state_.intrinsics.camera.project(pose_.apply(mark.position), &seen)) return;
    mark.state = LandmarkState::kPlaced;
    patches_.store(slot, 0, mark.generation, 0, first_.gray, at);
    truth_.emplace_back(static_cast<float>(seen.x()), static_cast<float>(seen.y()));
    state_.tracks.add(truth_.back() + cv::Point2f(kDrift, 0), cv::Point2f(), slot);
  }

  unisim_geometric_config config_;
  State state_;
  PatchStore patches_;
  PatchAtlas atlas_;
  Remeasure remeasure_{&atlas_};
  PreparedImage first_;
  PreparedImage second_;
  CameraPose pose_;
  std::vector<cv::Point2f> truth_;
};

CameraPlace near_first() {
  CameraPlace place;
  place.center = Eigen::Vector3d(0.1, -0.05, 0.3);
  place.R = Eigen::AngleAxisd(0.15, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return place;
}

}  // namespace

TEST_CASE("a track that has drifted is put back where its landmark's patch is found") {
  Drifted drifted(near_first());
  CHECK(drifted.error() == Approx(kDrift).epsilon(1e-3));
  const int moved = drifted.run();
  CHECK(moved > static_cast<int>(drifted.tracks() * 3 / 4));
  CHECK(drifted.error() < 0.25 * kDrift);
}

TEST_CASE("guessed landmarks and views that are too different are left alone") {
  Drifted guessed(near_first());
  for (int32_t slot = 0; slot < guessed.state().map.landmark_capacity(); ++slot) {
    guessed.state().map.landmark(slot).soft = true;
  }
  CHECK(guessed.run() == 0);

  CameraPlace far = near_first();
  far.R = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Drifted rolled(far);
  CHECK(rolled.run() == 0);
  CHECK(rolled.error() == Approx(kDrift).epsilon(1e-3));
}

}  // namespace unisim::geometric::test
