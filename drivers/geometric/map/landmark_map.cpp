// SPDX-License-Identifier: MIT
// Keyframes, landmarks and the observations between them, in memory fixed at creation.
#include "drivers/geometric/map/landmark_map.hpp"

#include <algorithm>

#include "drivers/geometric/map/least_needed.hpp"

namespace unisim::geometric {

LandmarkMap::LandmarkMap(const MapCapacity& capacity)
    : per_keyframe_(static_cast<size_t>(capacity.observations_per_keyframe)),
      slots_(capacity.keyframes),
      keyframes_(static_cast<size_t>(capacity.keyframes)),
      observations_(static_cast<size_t>(capacity.keyframes) * per_keyframe_),
      landmarks_(static_cast<size_t>(capacity.landmarks)) {
  free_.reserve(landmarks_.size());
  scratch_.reserve(landmarks_.size());
  for (int32_t slot = capacity.landmarks; slot-- > 0;) free_.push_back(slot);
}

Keyframe& LandmarkMap::push_keyframe(int32_t id, int32_t segment) {
  if (slots_.full()) drop_keyframe(least_needed_keyframe(*this));
  slots_.take(id);
  end_id_ = id + 1;
  Keyframe& added = keyframe(id);
  added = Keyframe{};
  added.id = id;
  added.segment = segment;
  return added;
}

void LandmarkMap::drop_keyframe(int32_t id) {
  for (int32_t i = 0; i < keyframe(id).observations; ++i) {
    const int32_t slot = observation(id, i).landmark;
    if (slot < 0) continue;
    unlink({id, i});
    if (landmark(slot).observations == 0 && !landmark(slot).followed) free_landmark(slot);
  }
  slots_.drop(id);
}

void LandmarkMap::unlink(const ObservationRef& ref) {
  Landmark& mark = landmark(observation(ref).landmark);
  ObservationRef before;
  for (ObservationRef at = mark.first; at.keyframe != ref.keyframe; at = observation(at).next) {
    before = at;
  }
  const ObservationRef after = observation(ref).next;
  (before.valid() ? observation(before).next : mark.first) = after;
  if (!after.valid()) mark.last = before;
  --mark.observations;
}

int32_t LandmarkMap::add_landmark(int32_t segment) {
  if (free_.empty()) free_oldest_landmarks();
  const int32_t slot = free_.back();
  free_.pop_back();
  Landmark& mark = landmark(slot);
  const uint32_t generation = mark.generation + 1;
  mark = Landmark{};
  mark.generation = generation;
  mark.state = LandmarkState::kCandidate;
  mark.segment = segment;
  return slot;
}

void LandmarkMap::free_landmark(int32_t slot) {
  for_each_observation(slot, [](const ObservationRef&, Observation& seen) { seen.landmark = -1; });
  Landmark& mark = landmark(slot);
  mark.state = LandmarkState::kFree;
  mark.first = mark.last = ObservationRef{};
  mark.observations = 0;
  free_.push_back(slot);
}

void LandmarkMap::free_oldest_landmarks() {
  scratch_.clear();
  for (int32_t slot = 0; slot < landmark_capacity(); ++slot) {
    const Landmark& mark = landmark(slot);
    if (mark.state != LandmarkState::kFree && !mark.followed) scratch_.push_back(slot);
  }
  // A sixteenth at a time, so that the search is rare.
  const size_t count = std::min(scratch_.size(), landmarks_.size() / 16 + 1);
  const auto last_seen = [this](int32_t a, int32_t b) {
    const int32_t seen_a = landmark(a).last.keyframe;
    const int32_t seen_b = landmark(b).last.keyframe;
    return seen_a != seen_b ? seen_a < seen_b : a < b;
  };
  std::partial_sort(scratch_.begin(), scratch_.begin() + static_cast<std::ptrdiff_t>(count),
                    scratch_.end(), last_seen);
  for (size_t i = 0; i < count; ++i) free_landmark(scratch_[i]);
}

ObservationRef LandmarkMap::write(int32_t id, int32_t slot, const cv::Point2f& at) {
  const ObservationRef ref{id, keyframe(id).observations++};
  Observation& seen = observation(ref);
  seen = Observation{};
  seen.landmark = slot;
  seen.x = at.x;
  seen.y = at.y;
  ++landmark(slot).observations;
  return ref;
}

bool LandmarkMap::observe(int32_t slot, const cv::Point2f& at, const cv::Point2f& sway) {
  const int32_t id = end_id_ - 1;
  if (full(id)) return false;
  Landmark& mark = landmark(slot);
  const bool first = mark.observations == 0;
  const ObservationRef ref = write(id, slot, at);
  observation(ref).sway = sway;
  (first ? mark.first : observation(mark.last).next) = ref;
  mark.last = ref;
  return true;
}

bool LandmarkMap::observe_in(int32_t id, int32_t slot, const cv::Point2f& at) {
  if (full(id)) return false;
  Landmark& mark = landmark(slot);
  ObservationRef before;
  ObservationRef after = mark.first;
  while (after.valid() && after.keyframe < id) {
    before = after;
    after = observation(after).next;
  }
  if (after.valid() && after.keyframe == id) return false;
  const ObservationRef ref = write(id, slot, at);
  observation(ref).next = after;
  (before.valid() ? observation(before).next : mark.first) = ref;
  if (!after.valid()) mark.last = ref;
  return true;
}

void LandmarkMap::free_abandoned() {
  for (int32_t slot = 0; slot < landmark_capacity(); ++slot) {
    const Landmark& mark = landmark(slot);
    const bool unplaced =
        mark.state == LandmarkState::kCandidate || mark.state == LandmarkState::kRefused;
    if (unplaced && !mark.followed) free_landmark(slot);
  }
}

ObservationRef LandmarkMap::anchor(int32_t slot) const {
  for (ObservationRef ref = landmark(slot).first; ref.valid(); ref = observation(ref).next) {
    if (counts(ref)) return ref;
  }
  return {};
}

int32_t LandmarkMap::support(int32_t slot) const {
  int32_t count = 0;
  for_each_observation(
      slot, [&](const ObservationRef& ref, const Observation&) { count += counts(ref) ? 1 : 0; });
  return count;
}

int64_t LandmarkMap::bytes() const {
  return static_cast<int64_t>(keyframes_.capacity() * sizeof(Keyframe) +
                              observations_.capacity() * sizeof(Observation) +
                              landmarks_.capacity() * sizeof(Landmark) +
                              (free_.capacity() + scratch_.capacity()) * sizeof(int32_t)) +
         slots_.bytes();
}

}  // namespace unisim::geometric
