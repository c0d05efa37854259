// SPDX-License-Identifier: MIT
// Gives positions to the tracks of the newest keyframe.
#include "drivers/geometric/map/landmark_growth.hpp"

#include <cmath>

#include "drivers/common/median.hpp"

namespace unisim::geometric {

namespace {
constexpr int kMinViews = 3;  // to triangulate
// After a large step two views do for so much between them: few landmarks get a third in time.
constexpr double kTwoViewParallaxRad = 2.0 * 0.017453292519943295;
constexpr int kMinSoftViews = 2;  // to guess
constexpr size_t kMaxViews = 48;  // per triangulation, spread over the track
constexpr size_t kMinNeighbours = 6;
constexpr double kNeighbourRadius = 60;  // pixels at the reference diagonal
constexpr double kSoftNeighbourWeight = 0.1;
constexpr double kFallbackWeight = 0.05;  // of the median depth
constexpr double kSoftGate = 6;           // pixels at the reference diagonal
}  // namespace

void LandmarkGrowth::reserve(size_t observations, size_t views) {
  neighbours_.reserve(observations);
  depths_.reserve(observations);
  views_.reserve(views);
}

bool LandmarkGrowth::gather(const State& state, int32_t slot) {
  views_.clear();
  state.map.for_each_observation(slot, [&](const ObservationRef& ref, const Observation& seen) {
    if (!state.map.counts(ref)) return;
    views_.push_back({&state.map.keyframe(ref.keyframe).pose,
                      state.intrinsics.camera.normalize(seen.still(state.intrinsics.readout_s))});
  });
  if (views_.size() > kMaxViews) {
    for (size_t i = 0; i < kMaxViews; ++i) {
      views_[i] = views_[i * (views_.size() - 1) / (kMaxViews - 1)];
    }
    views_.resize(kMaxViews);
  }
  return views_.size() >= 2;
}

bool LandmarkGrowth::triangulate_landmark(State* state, int32_t slot, double gate) {
  if (!gather(*state, slot)) return false;
  TriangulationOptions options;
  options.min_parallax_rad = kMinParallaxRad;
  options.max_error = gate * state->pixel_scale / state->intrinsics.camera.focal_px;
  const TriangulationResult result =
      triangulate(views_.data(), static_cast<int>(views_.size()), options);
  if (result.status != TriangulationStatus::kOk) return false;
  Landmark& mark = state->map.landmark(slot);
  mark.position = result.position;
  mark.state = LandmarkState::kPlaced;
  mark.soft = false;
  mark.measured_at = state->map.end_id() - 1;
  return true;
}

void LandmarkGrowth::collect_neighbours(State* state, int32_t keyframe) {
  neighbours_.clear();
  depths_.clear();
  const Keyframe& newest = state->map.keyframe(keyframe);
  for (int32_t i = 0; i < newest.observations; ++i) {
    const Observation& seen = state->map.observation(keyframe, i);
    if (seen.landmark < 0) continue;
    const Landmark& mark = state->map.landmark(seen.landmark);
    if (mark.state != LandmarkState::kPlaced) continue;
    const double depth = newest.pose.apply(mark.position).z();
    if (!(depth > kMinDepth)) continue;
    neighbours_.push_back({seen.pixel(), depth, mark.soft ? kSoftNeighbourWeight : 1.0});
    depths_.push_back(depth);
  }
  if (depths_.size() < kMinNeighbours) return;
  state->median_depth = drivers::median(&depths_);
}

void LandmarkGrowth::promote(State* state, int32_t slot) {
  Landmark& mark = state->map.landmark(slot);
  if (mark.observations < kMinViews || !gather(*state, slot)) return;
  if (parallax_angle(views_.data(), static_cast<int>(views_.size())) <= kMinParallaxRad) return;
  triangulate_landmark(state, slot, kTriangulationGate);
  mark.soft = false;
  mark.measured_at = state->map.end_id() - 1;
}

void LandmarkGrowth::guess_depth(State* state, int32_t slot, int32_t keyframe,
                                 const Eigen::Vector2d& pixel) {
  if (!(state->median_depth > 0) || !state->map.anchor(slot).valid()) return;
  double weight = kFallbackWeight;
  double inverse = kFallbackWeight / state->median_depth;
  const double radius = kNeighbourRadius * state->pixel_scale;
  for (const Neighbour& near : neighbours_) {
    const double distance2 = (near.pixel - pixel).squaredNorm() / (radius * radius);
    const double w = near.weight * std::exp(-distance2 / 2);
    weight += w;
    inverse += w / near.depth;
  }
  const CameraPose& pose = state->map.keyframe(keyframe).pose;
  const Eigen::Vector2d ray = state->intrinsics.camera.normalize(pixel);
  const double depth = weight / inverse;
  const Eigen::Vector3d position =
      pose.R.transpose() * (depth * Eigen::Vector3d(ray.x(), ray.y(), 1) - pose.t);
  bool consistent = position.allFinite();
  state->map.for_each_observation(slot, [&](const ObservationRef& ref, const Observation& seen) {
    if (!state->map.counts(ref)) return;
    const Keyframe& from = state->map.keyframe(ref.keyframe);
    consistent = consistent &&
                 reprojection_error(*state, seen, from, position) <= kSoftGate * state->pixel_scale;
  });
  if (!consistent) return;
  Landmark& mark = state->map.landmark(slot);
  mark.position = position;
  mark.state = LandmarkState::kPlaced;
  mark.soft = true;
}

/// Are there views enough to triangulate from?
bool LandmarkGrowth::measurable(const State& state, int32_t slot, bool large_step) {
  if (state.map.landmark(slot).observations >= kMinViews) return true;
  if (!large_step || !gather(state, slot)) return false;
  return parallax_angle(views_.data(), static_cast<int>(views_.size())) > kTwoViewParallaxRad;
}

void LandmarkGrowth::run(State* state, int32_t keyframe, bool large_step) {
  collect_neighbours(state, keyframe);
  const Keyframe& newest = state->map.keyframe(keyframe);
  for (int32_t i = 0; i < newest.observations; ++i) {
    const Observation& seen = state->map.observation(keyframe, i);
    if (seen.landmark < 0) continue;
    const Landmark& mark = state->map.landmark(seen.landmark);
    if (mark.state == LandmarkState::kPlaced) {
      if (mark.soft) promote(state, seen.landmark);
      continue;
    }
    if (mark.state != LandmarkState::kCandidate || mark.observations < kMinSoftViews) continue;
    if (measurable(*state, seen.landmark, large_step) &&
        triangulate_landmark(state, seen.landmark, kTriangulationGate)) {
      continue;
    }
    guess_depth(state, seen.landmark, keyframe, seen.still(state->intrinsics.readout_s));
  }
}

}  // namespace unisim::geometric
