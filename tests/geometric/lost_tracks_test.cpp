// SPDX-License-Identifier: MIT
// Tracks that a large step has lost are found again by what the images look like.
#include "drivers/geometric/places/lost_tracks.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/geometric/image/frame_tracker.hpp"
#include "drivers/geometric/map/capacities.hpp"
#include "tests/geometric/predictor_run.hpp"
#include "tests/geometric/prepared_view.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

/// Two keyframes of the room and tracks on a grid in the first, all of which have been lost.
class LargeStep {
 public:
  explicit LargeStep(const CameraPlace& second)
      : config_(default_config()), state_(config_, map_capacity(config_)) {
    state_.size = cv::Size(kWidth, kHeight);
    state_.intrinsics = Intrinsics::start(state_.size, kFocal);
    atlas_.open(state_.size);
    orb_.open(state_.size, {});
    lost_.reserve(config_.max_tracks, 1000);
    prepare_view(CameraPlace(), &first_);
    prepare_view(second, &second_);
    pose_.R = second.R.transpose();
    pose_.t = -pose_.R * second.center;
    for (int y = 30; y < kHeight - 30; y += 15) {
      for (int x = 30; x < kWidth - 30; x += 15) {
        const cv::Point2f at(static_cast<float>(x), static_cast<float>(y));
        state_.tracks.add(at, cv::Point2f(), state_.map.add_landmark(0));
      }
    }
    state_.tracks.seal();
    points_ = state_.tracks.point;
    landmarks_ = state_.tracks.landmark;
    lost_.note_keyframe(state_);
    state_.tracks.clear();
  }

  int run() { return lost_.run(first_, second_, cv::Point2f(), &state_); }
  bool many() const { return lost_.many(state_.tracks); }

  /// The wall ahead is at z = 3. @return false: near the border of the second image or outside
  bool truth(int32_t landmark, cv::Point2f* at) const {
    const cv::Point2f& from = point_of(landmark);
    const Eigen::Vector2d ray = state_.intrinsics.camera.normalize({from.x, from.y});
    Eigen::Vector2d seen;
    if (!state_.intrinsics.camera.project(pose_.apply(Eigen::Vector3d(3 * ray.x(), 3 * ray.y(), 3)),
                                          &seen)) {
      return false;
    }
    *at = {static_cast<float>(seen.x()), static_cast<float>(seen.y())};
    return inside_image(*at, state_.size, 16.0F);
  }
  const cv::Point2f& point_of(int32_t landmark) const {
    const auto i = std::find(landmarks_.begin(), landmarks_.end(), landmark) - landmarks_.begin();
    return points_[static_cast<size_t>(i)];
  }
  int in_view() const {
    cv::Point2f at;
    return static_cast<int>(std::count_if(landmarks_.begin(), landmarks_.end(),
                                          [&](int32_t slot) { return truth(slot, &at); }));
  }
  int wrong() const {
    int count = 0;
    for (size_t i = 0; i < state_.tracks.size(); ++i) {
      cv::Point2f at;
      truth(state_.tracks.landmark[i], &at);
      count += cv::norm(state_.tracks.point[i] - at) < 1.0 ? 0 : 1;
    }
    return count;
  }
  /// The first `count` tracks were kept, `off` pixels from where they should be.
  void keep(size_t count, float off) {
    for (size_t i = 0; i < landmarks_.size() && state_.tracks.size() < count; ++i) {
      cv::Point2f at;
      if (!truth(landmarks_[i], &at)) continue;
      const float angle = 2.4F * static_cast<float>(i);  // each to another side
      const cv::Point2f away(off * std::cos(angle), off * std::sin(angle));
      state_.tracks.add(at + away, cv::Point2f(), landmarks_[i]);
      state_.tracks.keyframe_point.back() = points_[i];
      state_.tracks.sealed.back() = 1;
    }
  }
  State& state() { return state_; }

 private:
  unisim_geometric_config config_;
  State state_;
  Orb orb_;
  PatchAtlas atlas_;
  LostTracks lost_{&orb_, &atlas_};
  PreparedImage first_;
  PreparedImage second_;
  CameraPose pose_;
  std::vector<cv::Point2f> points_;
  std::vector<int32_t> landmarks_;
};

/// Half a metre aside and nearer, and rolled by 25 degrees.
CameraPlace far_from_first() {
  CameraPlace place;
  place.center = Eigen::Vector3d(0.5, 0.1, 0.4);
  place.R = Eigen::AngleAxisd(0.44, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return place;
}

/// A walk of large steps, each frame a keyframe.
CameraPlace stride(int step) { return walk(9 * step); }

}  // namespace

TEST_CASE("tracks lost by a large step are found where they belong") {
  LargeStep step(far_from_first());
  REQUIRE(step.in_view() > 60);
  const int found = step.run();
  CHECK(found > step.in_view() / 2);
  CHECK(step.wrong() <= found / 50);
}

TEST_CASE("nothing is found in an image that shows another place") {
  CameraPlace behind;
  behind.R = Eigen::AngleAxisd(3.14159, Eigen::Vector3d::UnitY()).toRotationMatrix();
  LargeStep step(behind);
  CHECK(step.run() == 0);
}

TEST_CASE("tracks that were kept and contradict what is found go") {
  LargeStep step(far_from_first());
  step.keep(10, 40.0F);
  const int found = step.run();
  REQUIRE(found > 30);
  CHECK(static_cast<int>(step.state().tracks.size()) <=
        found + 4);  // some lie along their epipolar line
}

TEST_CASE("tracks that were kept and agree stay") {
  LargeStep step(far_from_first());
  step.keep(10, 0.0F);
  const int found = step.run();
  REQUIRE(found > 30);
  CHECK(static_cast<int>(step.state().tracks.size()) >= found + 8);
}

TEST_CASE("lost tracks are looked for where few are left in share and in number") {
  LargeStep step(CameraPlace{});
  CHECK(step.many());
  step.keep(100, 0.0F);
  CHECK(step.many());
  step.keep(150, 0.0F);  // half of those wanted
  CHECK_FALSE(step.many());
}

TEST_CASE("a walk of large steps is followed") {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  PredictorRun run(config);
  run.show_path(stride, 20, 1);
  const std::vector<unisim_sim3> found = run.window(0, 20);
  REQUIRE(found.size() == 20);
  CHECK(run.info().restarts == 0);
  CHECK(relative_error(found, run.places()) < 0.02);
}

}  // namespace unisim::geometric::test
