// SPDX-License-Identifier: MIT
// The landmarks of one place.
#include "drivers/geometric/places/place_view.hpp"

namespace unisim::geometric {

namespace {

// Two keyframes to each side see what this one happened to lose: .87 for .84 of the loops of
// redkitchen.
constexpr int32_t kNeighbours = 2;
constexpr int kMinSupport = 2;

}  // namespace

void PlaceViewer::add_keyframe(const State& state, int32_t keyframe, PlaceView* out) {
  const Keyframe& from = state.map.keyframe(keyframe);
  for (int32_t i = 0; i < from.observations; ++i) {
    const Observation& seen = state.map.observation(keyframe, i);
    if (seen.landmark < 0 || seen.outlier || taken_[static_cast<size_t>(seen.landmark)]) continue;
    const Landmark& mark = state.map.landmark(seen.landmark);
    if (mark.state != LandmarkState::kPlaced || mark.soft) continue;
    if (state.map.support(seen.landmark) < kMinSupport) continue;
    taken_[static_cast<size_t>(seen.landmark)] = 1;
    out->landmark.push_back(seen.landmark);
  }
}

void PlaceViewer::collect(const State& state, const DescriptorStore& store, int32_t keyframe,
                          PlaceView* out) {
  out->keyframe = keyframe;
  out->landmark.clear();
  out->descriptor.clear();
  out->owner.clear();
  add_keyframe(state, keyframe, out);
  out->own = out->landmark.size();
  const int32_t segment = state.map.keyframe(keyframe).segment;
  for (int32_t k = keyframe - kNeighbours; k <= keyframe + kNeighbours; ++k) {
    if (k == keyframe || !state.map.holds(k)) continue;
    const Keyframe& from = state.map.keyframe(k);
    if (from.posed && from.segment == segment) add_keyframe(state, k, out);
  }
  for (size_t l = 0; l < out->landmark.size(); ++l) {
    const int32_t slot = out->landmark[l];
    taken_[static_cast<size_t>(slot)] = 0;
    store.append(slot, state.map.landmark(slot).generation, &out->descriptor);
    out->owner.resize(out->descriptor.size(), static_cast<int32_t>(l));
  }
}

}  // namespace unisim::geometric
