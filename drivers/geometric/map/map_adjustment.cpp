// SPDX-License-Identifier: MIT
// A part of the map as a bundle adjustment problem, and the way back.
#include "drivers/geometric/map/map_adjustment.hpp"

#include <algorithm>

namespace unisim::geometric {

namespace {
constexpr int32_t kNoCamera = -1;
constexpr int32_t kFreeCamera = -2;  // marks before indices are given
constexpr int32_t kFixedCamera = -3;
constexpr int kMinViews = 2;
}  // namespace

MapAdjustment::MapAdjustment(const BundleCapacity& capacity, const MapCapacity& map)
    : problem_(capacity),
      adjuster_(capacity),
      camera_of_(static_cast<size_t>(map.keyframes), kNoCamera),
      marked_(static_cast<size_t>(map.landmarks), 0) {
  keyframes_.reserve(static_cast<size_t>(capacity.cameras));
  landmarks_.reserve(static_cast<size_t>(capacity.points));
  generations_.reserve(static_cast<size_t>(capacity.points));
  wanted_.reserve(static_cast<size_t>(map.landmarks));
  camera_scratch_.reserve(static_cast<size_t>(capacity.cameras));
}

void MapAdjustment::build(const State& state, const int32_t* ids, size_t count,
                          const std::vector<LoopObservation>& loops) {
  problem_.clear();
  keyframes_.clear();
  landmarks_.clear();
  generations_.clear();
  options_.pixel_scale = state.pixel_scale;
  state.intrinsics.give(state.early(), &problem_.intrinsics);
  collect_landmarks(state, ids, count);
  add_cameras(state, ids, count);
  for (const int32_t slot : wanted_) add_landmark(state, slot, loops);
}

void MapAdjustment::collect_landmarks(const State& state, const int32_t* ids, size_t count) {
  wanted_.clear();
  for (size_t k = 0; k < count; ++k) {
    const Keyframe& from = state.map.keyframe(ids[k]);
    for (int32_t i = 0; i < from.observations; ++i) {
      const int32_t slot = state.map.observation(ids[k], i).landmark;
      if (slot < 0 || marked_[static_cast<size_t>(slot)]) continue;
      if (state.map.landmark(slot).state != LandmarkState::kPlaced) continue;
      marked_[static_cast<size_t>(slot)] = 1;
      wanted_.push_back(slot);
    }
  }
  for (const int32_t slot : wanted_) marked_[static_cast<size_t>(slot)] = 0;
}

void MapAdjustment::add_cameras(const State& state, const int32_t* ids, size_t count) {
  std::fill(camera_of_.begin(), camera_of_.end(), kNoCamera);
  for (size_t k = 0; k < count; ++k) camera_of_[state.map.slot_of(ids[k])] = kFreeCamera;
  for (const int32_t slot : wanted_) {
    const ObservationRef anchor = state.map.anchor(slot);
    if (!anchor.valid()) continue;
    int32_t& camera = camera_of_[state.map.slot_of(anchor.keyframe)];
    if (camera == kNoCamera) camera = kFixedCamera;
  }
  for (const int32_t id : state.map.ids()) {
    int32_t& camera = camera_of_[state.map.slot_of(id)];
    if (camera == kNoCamera) continue;
    camera = problem_.add_camera(state.map.keyframe(id).pose, camera == kFixedCamera);
    if (camera >= 0) keyframes_.push_back(id);
  }
}

void MapAdjustment::add_landmark(const State& state, int32_t slot,
                                 const std::vector<LoopObservation>& loops) {
  const Landmark& mark = state.map.landmark(slot);
  if (problem_.add_point(mark.position) < 0) return;
  int views = 0;
  auto again = std::lower_bound(
      loops.begin(), loops.end(), slot,
      [](const LoopObservation& seen, int32_t landmark) { return seen.landmark < landmark; });
  // Cameras of a point come in ascending order; one that sees it anyway keeps what it sees.
  const auto add_loops_before = [&](int32_t keyframe) {
    for (; again != loops.end() && again->landmark == slot && again->keyframe < keyframe; ++again) {
      if (!state.map.holds(again->keyframe)) continue;
      const int32_t camera = camera_of_[state.map.slot_of(again->keyframe)];
      if (camera < 0 || again->generation != mark.generation) continue;
      const cv::Point2f& at = again->point;
      views += problem_.add_observation(camera, at.x, at.y, 1.0) ? 1 : 0;
    }
  };
  state.map.for_each_observation(slot, [&](const ObservationRef& ref, const Observation& seen) {
    add_loops_before(ref.keyframe);
    const int32_t camera = camera_of_[state.map.slot_of(ref.keyframe)];
    if (camera < 0 || !state.map.counts(ref)) return;
    views +=
        problem_.add_observation(camera, seen.x, seen.y, 1.0, {seen.sway.x, seen.sway.y}) ? 1 : 0;
  });
  add_loops_before(state.map.end_id());
  if (views < kMinViews) {
    problem_.drop_point();
    return;
  }
  landmarks_.push_back(slot);
  generations_.push_back(mark.generation);
}

BundleResult MapAdjustment::solve(int iterations, double tolerance) {
  options_.max_iterations = iterations;
  options_.relative_tolerance = tolerance;
  return adjuster_.solve(&problem_, options_);
}

BundlePrecision MapAdjustment::precision(const int32_t* ids, size_t count) {
  camera_scratch_.clear();
  for (size_t k = 0; k < count; ++k) {
    const auto found = std::lower_bound(keyframes_.begin(), keyframes_.end(), ids[k]);
    if (found == keyframes_.end() || *found != ids[k]) continue;
    camera_scratch_.push_back(static_cast<int32_t>(found - keyframes_.begin()));
  }
  return adjuster_.precision(problem_, options_, camera_scratch_.data(),
                             static_cast<int>(camera_scratch_.size()));
}

void MapAdjustment::write_back(State* state) const {
  for (size_t c = 0; c < keyframes_.size(); ++c) {
    const BundleCamera& camera = problem_.camera(static_cast<int>(c));
    if (!camera.fixed) state->map.keyframe(keyframes_[c]).pose = camera.pose;
  }
  for (size_t p = 0; p < landmarks_.size(); ++p) {
    state->map.landmark(landmarks_[p]).position = problem_.point(static_cast<int>(p)).position;
  }
  state->intrinsics.take(problem_.intrinsics, state->size);
}

int64_t MapAdjustment::bytes() const {
  const BundleCapacity& capacity = problem_.capacity();
  const size_t problem = static_cast<size_t>(capacity.cameras) * sizeof(BundleCamera) +
                         static_cast<size_t>(capacity.points) * sizeof(BundlePoint) +
                         static_cast<size_t>(capacity.observations) * sizeof(BundleObservation);
  const size_t names = (keyframes_.capacity() + landmarks_.capacity() + generations_.capacity() +
                        wanted_.capacity() + camera_of_.capacity() + camera_scratch_.capacity()) *
                           sizeof(int32_t) +
                       marked_.capacity();
  return static_cast<int64_t>(problem + names + adjuster_.memory_bytes());
}

}  // namespace unisim::geometric
