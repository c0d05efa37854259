// SPDX-License-Identifier: MIT
// Results out, by copy.
#include "core/session.hpp"

namespace unisim {

Status Session::pose(int32_t keyframe, PoseOutput* pose) const {
  if (map_.keyframes.gone(keyframe)) return Status::kRetired;
  if (!map_.keyframes.has(keyframe)) return Status::kInvalidArgument;
  const int32_t source = map_.keyframes.pose_source(keyframe);
  if (source < 0) return Status::kNotReady;
  const Keyframe& asked = map_.keyframes[keyframe];
  pose->T_world_kf = map_.keyframe_pose(source);
  pose->timestamp_ns = asked.timestamp_ns;
  pose->state = asked.state;
  pose->confidence = asked.confidence();
  pose->submap = asked.best_submap;
  pose->segment = asked.segment;
  return Status::kOk;
}

}  // namespace unisim
