// SPDX-License-Identifier: MIT
// What a run gives out, kept on disk as it comes.
#include "tools/replay/run_record.hpp"

#include <algorithm>

namespace unisim::replay {

void RunRecord::on_keyframe(int32_t id, const unisim_frame& frame) {
  Keyframe keyframe;
  keyframe.frame_index = frame.index;
  keyframes_.put(id, keyframe);
}

void RunRecord::on_window(int32_t submap_id, const unisim_window_prediction& /*window*/) {
  submaps_ = std::max(submaps_, submap_id + 1);
}

void RunRecord::on_live_pose(const pipeline::LivePose& pose) {
  live_.append({pose.timestamp_ns, pose.T_world_cam});
}

void RunRecord::on_retired(const unisim_retired& retired, const unisim_pose* pose) {
  book_.take(retired);
  if (pose == nullptr) return;
  Keyframe keyframe = keyframes_.get(retired.keyframe_id);
  keyframe.pose = *pose;
  keyframe.pose.segment = retired.segment;
  keyframes_.put(retired.keyframe_id, keyframe);
}

bool RunRecord::find(const unisim_session* session, int32_t keyframe, unisim_pose* pose) const {
  *pose = {};
  pose->struct_size = sizeof *pose;
  const unisim_status status = unisim_get_pose(session, keyframe, pose);
  if (status != UNISIM_ERR_RETIRED) return status == UNISIM_OK;
  *pose = keyframes_.get(keyframe).pose;
  return pose->struct_size > 0 && book_.find(session, keyframe, &pose->T_world_kf);
}

}  // namespace unisim::replay
