// SPDX-License-Identifier: MIT
// Keyframes, landmarks and observations as they are saved. The lists of observations are built
// anew, so that no file can make a loop of one.
#include <Eigen/LU>
#include <algorithm>

#include "drivers/geometric/map/landmark_map.hpp"

namespace unisim::geometric {

namespace {

constexpr int32_t kMostFailures = 1 << 20;
constexpr double kFar = 1e9;  // units of the map
constexpr double kNotTurned = 1e-6;

void archive_vector(drivers::Archive* io, Eigen::Vector3d* vector) {
  for (int k = 0; k < 3; ++k) io->number((*vector)(k), -kFar, kFar);
}

void archive_pose(drivers::Archive* io, CameraPose* pose) {
  for (int k = 0; k < 9; ++k) io->number(pose->R.data()[k], -2.0, 2.0);
  archive_vector(io, &pose->t);
  const double off = (pose->R * pose->R.transpose() - Eigen::Matrix3d::Identity()).norm();
  io->require(off < kNotTurned && pose->R.determinant() > 0, "a pose is no rotation");
}

}  // namespace

/// A landmark that is worth keeping: those without a place live only while they are followed.
bool LandmarkMap::lasts(int32_t slot) const {
  const Landmark& mark = landmark(slot);
  return mark.state == LandmarkState::kPlaced && mark.observations > 0;
}

void LandmarkMap::archive(drivers::Archive* io, int32_t segments, double readout_s) {
  io->part("landmarks");
  int32_t count = io->reading() ? 0 : landmark_capacity();
  while (count > 0 && !lasts(count - 1)) --count;
  io->number(count);
  if (io->reading() && count > landmark_capacity()) {
    io->fail("there are " + std::to_string(count) + ", max_landmarks is " +
             std::to_string(landmark_capacity()) + ": raise it");
  }
  io->require(count >= 0, "their number is out of range");
  for (int32_t slot = 0; slot < count; ++slot) archive_landmark(io, slot, segments);
  io->part("keyframes");
  auto held = static_cast<int32_t>(ids().size());
  io->number(held);
  const auto most = static_cast<int32_t>(keyframes_.size());
  if (io->reading() && held > most) {
    io->fail("there are " + std::to_string(held) + ", max_keyframes is " + std::to_string(most) +
             ": raise it");
  }
  io->require(held >= 1, "there are none");
  for (int32_t k = 0; k < held; ++k) {
    int32_t id = io->reading() ? 0 : ids()[static_cast<size_t>(k)];
    io->number(id, io->reading() ? end_id_ : 0, drivers::kMostKeyframeId);
    if (io->reading()) push_keyframe(id, 0);
    archive_keyframe(io, id, segments, readout_s);
  }
  if (!io->reading()) return;
  free_.clear();
  for (int32_t slot = landmark_capacity(); slot-- > 0;) {
    Landmark& mark = landmark(slot);
    if (mark.state == LandmarkState::kPlaced && mark.observations == 0) {
      io->fail("a landmark was never seen");
    }
    if (mark.state == LandmarkState::kFree) free_.push_back(slot);
  }
}

void LandmarkMap::archive_landmark(drivers::Archive* io, int32_t slot, int32_t segments) {
  Landmark& mark = landmark(slot);
  bool placed = lasts(slot);
  io->number(mark.generation);
  io->flag(placed);
  if (!placed) return;
  io->require(mark.generation > 0, "a landmark is of no generation");
  mark.state = LandmarkState::kPlaced;
  io->flag(mark.soft);
  io->number(mark.failures, 0, kMostFailures);
  io->number(mark.segment, 0, segments - 1);
  archive_vector(io, &mark.position);
}

void LandmarkMap::archive_keyframe(drivers::Archive* io, int32_t id, int32_t segments,
                                   double readout_s) {
  Keyframe& frame = keyframe(id);
  io->number(frame.segment, 0, segments - 1);
  io->flag(frame.posed);
  archive_pose(io, &frame.pose);
  io->number(frame.center_sigma, 0.0, kFar);
  int32_t seen = 0;
  for (int32_t i = 0; i < frame.observations; ++i) {
    const int32_t slot = observation(id, i).landmark;
    seen += slot >= 0 && lasts(slot) ? 1 : 0;
  }
  io->number(seen);
  if (io->reading() && seen > static_cast<int32_t>(per_keyframe_)) {
    io->fail("one has " + std::to_string(seen) + " observations, there is room for " +
             std::to_string(per_keyframe_) + ": raise max_tracks");
  }
  io->require(seen >= 0, "a number of observations is out of range");
  for (int32_t i = 0, k = 0; k < seen; ++i) {
    if (io->reading()) {
      load_observation(io);
    } else {
      const int32_t slot = observation(id, i).landmark;
      if (slot < 0 || !lasts(slot)) continue;
      Observation saved = observation(ObservationRef{id, i});
      const Eigen::Vector2d still = saved.still(readout_s);
      saved.x = static_cast<float>(still.x());
      saved.y = static_cast<float>(still.y());
      archive_observation(io, saved);
    }
    ++k;
  }
}

void LandmarkMap::archive_observation(drivers::Archive* io, Observation& seen) const {
  // No image is larger.
  constexpr double kMostPixels = 1 << 20;
  io->number(seen.landmark, 0, landmark_capacity() - 1);
  io->number(seen.x);
  io->number(seen.y);
  io->flag(seen.outlier);
  const double reach = std::max(std::abs(seen.x), std::abs(seen.y));
  io->require(reach <= kMostPixels && seen.x == seen.x && seen.y == seen.y,
              "an observation lies in no image");
}

/// Into the newest keyframe.
void LandmarkMap::load_observation(drivers::Archive* io) {
  Observation seen;
  archive_observation(io, seen);
  const Landmark& mark = landmark(seen.landmark);
  io->require(mark.state == LandmarkState::kPlaced, "one saw a landmark that is not there");
  io->require(mark.last.keyframe != end_id_ - 1, "one saw a landmark twice");
  static_cast<void>(observe(seen.landmark, {seen.x, seen.y}));
  observation(mark.last).outlier = seen.outlier;
}

}  // namespace unisim::geometric
