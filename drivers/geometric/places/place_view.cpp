// SPDX-License-Identifier: MIT
// The landmarks of one place, and which features of an image show them.
#include "drivers/geometric/places/place_view.hpp"

#include <algorithm>

namespace unisim::geometric {

namespace {

// Two keyframes to each side see what this one happened to lose: .87 for .84 of the loops of
// redkitchen.
constexpr int32_t kNeighbours = 2;
constexpr int kMinSupport = 2;
// Redkitchen, pairs of keyframes by overlap: with 72 and 0.9 too many wrong pairs come through for
// the rounds of the pose search.
constexpr float kMaxDistance = 64.0F;
constexpr float kMaxRatio = 0.8F;
constexpr int kNearest = 4;  // of which one belongs to another landmark, as a rule

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

void match_features(const OrbFeatureSet& features, const PlaceView& place,
                    std::vector<FeaturePair>* out) {
  out->clear();
  if (features.point.size() < 2 || place.descriptor.size() < 2) return;
  // cv::Mat has no read-only view; the matcher only reads.
  auto* rows = const_cast<uint8_t*>(place.descriptor.front().data());
  const cv::Mat landmarks(static_cast<int>(place.descriptor.size()), kOrbBytes, CV_8UC1, rows);
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(features.descriptor, landmarks, nearest, kNearest);
  std::vector<FeaturePair> best(place.landmark.size(), {-1, -1, 0.0F});
  for (const auto& found : nearest) {
    if (found.empty() || found[0].distance > kMaxDistance) continue;
    const int32_t owner = place.owner[static_cast<size_t>(found[0].trainIdx)];
    const auto other = std::find_if(found.begin() + 1, found.end(), [&](const cv::DMatch& match) {
      return place.owner[static_cast<size_t>(match.trainIdx)] != owner;
    });
    if (other != found.end() && found[0].distance > kMaxRatio * other->distance) continue;
    FeaturePair& kept = best[static_cast<size_t>(owner)];
    if (kept.feature >= 0 && kept.distance <= found[0].distance) continue;
    kept = {found[0].queryIdx, owner, found[0].distance};
  }
  std::copy_if(best.begin(), best.end(), std::back_inserter(*out),
               [](const FeaturePair& pair) { return pair.feature >= 0; });
}

}  // namespace unisim::geometric
