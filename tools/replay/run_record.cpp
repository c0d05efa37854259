// SPDX-License-Identifier: MIT
// What a run gives out, kept on disk as it comes.
#include "tools/replay/run_record.hpp"

#include <algorithm>

namespace unisim::replay {

void RunRecord::on_keyframe(int32_t id, const unisim_frame& frame) {
  Keyframe keyframe;
  keyframe.frame_index = frame.index;
  keyframes_.put(id, keyframe);
  newest_ = id;
}

/// Follows upon on_keyframe() with the state that the keyframe brought about.
void RunRecord::on_progress(const pipeline::Progress& progress) {
  if (newest_ < 0) return;
  Keyframe keyframe = keyframes_.get(newest_);
  keyframe.reason = progress.reason;
  keyframes_.put(newest_, keyframe);
  newest_ = -1;
}

void RunRecord::on_window(int32_t submap_id, const unisim_window_prediction& /*window*/) {
  submaps_ = std::max(submaps_, submap_id + 1);
}

void RunRecord::on_live_pose(const pipeline::LivePose& pose) {
  live_.append({pose.timestamp_ns, pose.T_world_cam});
}

}  // namespace unisim::replay
