// SPDX-License-Identifier: MIT
// Latest pose of any keyframe of a run, kept by the session or not.
#include "drivers/pipeline/pose_history.hpp"

namespace unisim::pipeline {

void PoseHistory::take(const unisim_retired& retired, const unisim_pose* pose) {
  book_.take(retired);
  if (pose == nullptr) return;
  unisim_pose kept = *pose;
  kept.segment = retired.segment;
  retired_.put(retired.keyframe_id, kept);
}

bool PoseHistory::read(const unisim_session* session, int32_t keyframe, unisim_pose* pose) const {
  *pose = {};
  pose->struct_size = sizeof *pose;
  const unisim_status status = unisim_get_pose(session, keyframe, pose);
  if (status != UNISIM_ERR_RETIRED) return status == UNISIM_OK;
  *pose = retired_.get(keyframe);
  return pose->struct_size > 0 && book_.find(session, keyframe, &pose->T_world_kf);
}

}  // namespace unisim::pipeline
