// SPDX-License-Identifier: MIT
// Outlier rules of the running state, and its segments.
#include "drivers/geometric/map/state.hpp"

#include <algorithm>
#include <limits>

namespace unisim::geometric {

namespace {
constexpr int kMaxFailures = 2;

void cull_landmark(State* state, int32_t slot, double gate) {
  Landmark& mark = state->map.landmark(slot);
  int good = 0;
  state->map.for_each_observation(slot, [&](const ObservationRef& ref, Observation& seen) {
    const Keyframe& from = state->map.keyframe(ref.keyframe);
    if (!from.posed || seen.outlier) return;
    if (reprojection_error(*state, seen, from, mark.position) > gate) {
      seen.outlier = true;
    } else {
      ++good;
    }
  });
  if (good >= 2) return;
  mark.soft = false;
  if (++mark.failures >= kMaxFailures) {
    mark.state = LandmarkState::kRefused;
    return;
  }
  mark.state = LandmarkState::kCandidate;
  state->map.for_each_observation(
      slot, [](const ObservationRef&, Observation& seen) { seen.outlier = false; });
}

}  // namespace

void sort_by_landmark(std::vector<LoopObservation>* observations) {
  std::sort(observations->begin(), observations->end(),
            [](const LoopObservation& a, const LoopObservation& b) {
              return a.landmark != b.landmark ? a.landmark < b.landmark : a.keyframe < b.keyframe;
            });
}

void State::begin(int32_t id) {
  segment = segments++;
  segment_start = id;
  initialised = false;
  posed = 0;
}

void State::enter(int32_t older_segment) {
  segment = older_segment;
  segment_start = map.end_id();
  posed = 0;
  for (const int32_t k : map.ids()) {
    const Keyframe& held = map.keyframe(k);
    if (held.segment != segment) continue;
    segment_start = std::min(segment_start, k);
    posed += held.posed ? 1 : 0;
  }
}

bool State::other_segments() const {
  return std::any_of(map.ids().begin(), map.ids().end(), [this](int32_t k) {
    return map.keyframe(k).posed && map.keyframe(k).segment != segment;
  });
}

int32_t State::posed_before(int32_t id, int32_t of_segment) const {
  const std::vector<int32_t>& ids = map.ids();
  for (auto after = std::lower_bound(ids.begin(), ids.end(), id); after != ids.begin(); --after) {
    const Keyframe& before = map.keyframe(*(after - 1));
    if (before.posed && before.segment == of_segment) return before.id;
  }
  return -1;
}

double reprojection_error(const State& state, const Observation& seen, const Keyframe& from,
                          const Eigen::Vector3d& position) {
  Eigen::Vector2d at;
  const CameraModel& camera = state.intrinsics.camera;
  if (!camera.project_undistorted(from.pose.apply(position), &at)) {
    return std::numeric_limits<double>::infinity();
  }
  const double error = (at - camera.undistort(seen.still(state.intrinsics.readout_s))).norm();
  return error >= 0 ? error : std::numeric_limits<double>::infinity();
}

void mark_outliers(State* state, int32_t keyframe, double gate) {
  const Keyframe& from = state->map.keyframe(keyframe);
  for (int32_t i = 0; i < from.observations; ++i) {
    Observation& seen = state->map.observation(ObservationRef{keyframe, i});
    if (seen.landmark < 0) continue;
    const Landmark& mark = state->map.landmark(seen.landmark);
    if (mark.state != LandmarkState::kPlaced) continue;
    seen.outlier =
        reprojection_error(*state, seen, from, mark.position) > gate * state->pixel_scale;
  }
}

void cull(State* state, const int32_t* keyframes, size_t count, double gate) {
  for (size_t k = 0; k < count; ++k) {
    const Keyframe& from = state->map.keyframe(keyframes[k]);
    for (int32_t i = 0; i < from.observations; ++i) {
      const int32_t slot = state->map.observation(keyframes[k], i).landmark;
      if (slot < 0 || state->map.landmark(slot).state != LandmarkState::kPlaced) continue;
      cull_landmark(state, slot, gate * state->pixel_scale);
    }
  }
}

}  // namespace unisim::geometric
