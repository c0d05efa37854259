// SPDX-License-Identifier: MIT
// The running map: what is done where tracks, or the whole camera, are lost.
#include "drivers/geometric/map/mapper.hpp"

namespace unisim::geometric {

namespace {

// Keyframes without pose until a new segment begins, and the time it takes at least: as long a
// hand, a blur or a white wall is waited for. With keyframes so dense, or times so wrong, that it
// never passes, many keyframes do.
constexpr int kMaxLostInRow = 2;
constexpr int kManyLostInRow = 15;
constexpr int64_t kWaitNs = 500000000;

}  // namespace

void Mapper::look_for_lost_tracks() {
  loses_much_ = front_end_.has_keyframe() && lost_tracks_.many(state_.tracks);
  if (!loses_much_) return;
  const int found =
      lost_tracks_.run(front_end_.keyframe(), front_end_.current(), front_end_.flow(), &state_);
  if (found > 0) front_end_.space_out(&state_.tracks);
}

void Mapper::recover(int32_t id, const CameraPose& near) {
  if (!state_.map.holds(id) || state_.map.keyframe(id).posed) return;
  const FramePose found = poses_.solve_old(state_, id, near);
  if (!found.good) return;
  Keyframe& lost = state_.map.keyframe(id);
  lost.pose = found.pose;
  lost.posed = true;
  ++state_.posed;
  mark_outliers(&state_, id, 2 * kInlierGate);
}

bool Mapper::waited_long() const {
  if (lost_in_row_ < kMaxLostInRow) return false;
  return time_ns_ - lost_since_ns_ >= kWaitNs || lost_in_row_ >= kManyLostInRow;
}

bool Mapper::relocalise(int32_t id) {
  if (!places_.relocalise(look(id), &found_)) return false;
  let_go();
  state_.tracks.clear();
  for (const PatchMatch& match : found_.matches) {
    state_.tracks.add(match.point, cv::Point2f(), match.landmark);
    state_.map.landmark(match.landmark).followed = true;
  }
  state_.intrinsics = lost_intrinsics_;
  const int32_t segment = state_.map.keyframe(found_.keyframe).segment;
  if (segment != state_.segment || !state_.initialised) state_.enter(segment);
  state_.initialised = true;
  FramePose pose = poses_.refine(state_, found_.pose);
  pose.good = true;  // more has been asked of it than of a pose from tracks
  take_pose(id, pose);
  return true;
}

void Mapper::lose(int32_t id) {
  if (lost_in_row_++ == 0) {
    lost_since_ns_ = time_ns_;
    lost_intrinsics_ = state_.intrinsics;
  }
  if (relocalise(id)) return;
  if (waited_long()) {
    begin_segment(id);
    try_start(id);
    return;
  }
  state_.map.push_keyframe(id, state_.segment);
  observe_tracks(0);
  detect_tracks();
}

void Mapper::begin_segment(int32_t id) {
  ++counts_.restarts;
  state_.begin(id);
  adjusted_posed_ = 0;
  bootstrap_.restart(id);
  let_go();
  for (size_t i = 0; i < state_.tracks.size(); ++i) {
    const int32_t slot = state_.map.add_landmark(state_.segment);
    state_.map.landmark(slot).followed = true;
    state_.tracks.landmark[i] = slot;
  }
}

}  // namespace unisim::geometric
