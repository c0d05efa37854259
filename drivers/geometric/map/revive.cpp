// SPDX-License-Identifier: MIT
// Finds landmarks again that went out of sight.
#include "drivers/geometric/map/revive.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "drivers/geometric/image/frame_tracker.hpp"
#include "drivers/geometric/map/view_difference.hpp"

namespace unisim::geometric {

namespace {
constexpr int kMinSupport = 3;
constexpr float kSearchMargin = 12.0F;
constexpr float kAcceptMargin = 10.0F;
constexpr double kMaxDistance = 15.0;  // pixels at the reference diagonal
constexpr double kOccupied = 0.5;      // of the feature spacing
constexpr double kCrowded = 0.35;
constexpr double kNewViewCost = 0.5;  // a patch is kept when no kept one is nearer in view
}  // namespace

void Revive::reserve(size_t landmarks) { candidates_.reserve(landmarks); }

void Revive::collect(const PatchStore& patches, const CameraPose& pose, int32_t keyframe,
                     const cv::Mat& occupied, const State& state) {
  candidates_.clear();
  for (int32_t slot = 0; slot < state.map.landmark_capacity(); ++slot) {
    const Landmark& mark = state.map.landmark(slot);
    if (mark.state != LandmarkState::kPlaced || mark.soft || mark.followed) continue;
    if (mark.segment != state.segment) continue;
    if (mark.last.keyframe < keyframe - state.config.revive_age) continue;
    Eigen::Vector2d pixel;
    if (!state.intrinsics.camera.project(pose.apply(mark.position), &pixel)) continue;
    const cv::Point2f expected(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    if (!inside_image(expected, state.size, kSearchMargin)) continue;
    if (occupied.at<uint8_t>(cv::Point(expected))) continue;
    if (state.map.support(slot) < kMinSupport) continue;
    Candidate best{slot, -1, kNoView, expected};
    for (int v = 0; v < kPatchesPerLandmark; ++v) {
      const PatchView& view = patches.view(slot, v);
      if (view.generation != mark.generation || !state.map.holds(view.keyframe)) continue;
      const double cost =
          view_difference(state.map.keyframe(view.keyframe).pose, pose, mark.position);
      if (cost < best.cost) {
        best.cost = cost;
        best.patch = v;
      }
    }
    if (best.patch >= 0) candidates_.push_back(best);
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.landmark < b.landmark;
  });
  const auto limit = static_cast<size_t>(state.config.revive_tries);
  if (candidates_.size() > limit) candidates_.resize(limit);
}

void Revive::draw(const PatchStore& patches, size_t i, size_t j) {
  const Candidate& candidate = candidates_[i];
  patches.pixels(candidate.landmark, candidate.patch).copyTo(atlas_.tile(j));
  const cv::Point2f& offset = patches.view(candidate.landmark, candidate.patch).offset;
  const cv::Point middle = atlas_.corner(j) + cv::Point(kPatchSide / 2, kPatchSide / 2);
  atlas_.add(cv::Point2f(middle) + offset, candidate.expected);
}

int Revive::run(const PatchStore& patches, const PreparedImage& current, const CameraPose& pose,
                int32_t keyframe, const cv::Point2f& flow, cv::Mat* mask, State* state) {
  const int reach = std::max(2, static_cast<int>(kOccupied * state->feature_spacing));
  for (const cv::Point2f& p : state->tracks.point) {
    cv::circle(*mask, cv::Point(p), reach, cv::Scalar(255), -1);
  }
  collect(patches, pose, keyframe, *mask, *state);
  const double distance = kMaxDistance * state->pixel_scale;
  const int crowd = std::max(2, static_cast<int>(kCrowded * state->feature_spacing));
  int added = 0;
  const auto take = [&](size_t i, size_t j) {
    if (!atlas_.found(j, current, distance, kAcceptMargin)) return;
    const cv::Point at(atlas_.found_at(j));
    if (mask->at<uint8_t>(at)) return;
    cv::circle(*mask, at, crowd, cv::Scalar(255), -1);
    state->tracks.add(atlas_.found_at(j), flow, candidates_[i].landmark);
    state->map.landmark(candidates_[i].landmark).followed = true;
    ++added;
  };
  atlas_.look_for(
      candidates_.size(), current, kMinTexture, [&](size_t i, size_t j) { draw(patches, i, j); },
      [] {}, take);
  return added;
}

void Revive::store_patches(const State& state, const PreparedImage& current, int32_t keyframe,
                           PatchStore* patches) const {
  const CameraPose& pose = state.map.keyframe(keyframe).pose;
  for (size_t i = 0; i < state.tracks.size(); ++i) {
    const int32_t slot = state.tracks.landmark[i];
    const Landmark& mark = state.map.landmark(slot);
    if (mark.state != LandmarkState::kPlaced || mark.soft) continue;
    if (!inside_image(state.tracks.point[i], state.size, kAcceptMargin)) continue;
    int oldest = 0;
    bool known = false;
    for (int v = 0; v < kPatchesPerLandmark; ++v) {
      const PatchView& view = patches->view(slot, v);
      const bool usable = view.generation == mark.generation && state.map.holds(view.keyframe);
      const int32_t age = usable ? view.keyframe : -1;
      const PatchView& other = patches->view(slot, oldest);
      const bool other_usable =
          other.generation == mark.generation && state.map.holds(other.keyframe);
      if (age < (other_usable ? other.keyframe : -1)) oldest = v;
      if (usable && view_difference(state.map.keyframe(view.keyframe).pose, pose, mark.position) <
                        kNewViewCost) {
        known = true;
      }
    }
    if (!known) {
      patches->store(slot, oldest, mark.generation, keyframe, current.gray, state.tracks.point[i]);
    }
  }
}

int64_t Revive::bytes() const {
  return static_cast<int64_t>(candidates_.capacity() * sizeof(Candidate));
}

}  // namespace unisim::geometric
