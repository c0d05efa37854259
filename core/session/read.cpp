// SPDX-License-Identifier: MIT
// Results out, by copy.
#include "core/session.hpp"

namespace unisim {

Sim3 Session::submap_pose(const Submap& submap) const {
  if (submap.own_node) return graph_.pose(submap.node);
  return graph_.pose(submap.node) * submap.T_node_submap;
}

Sim3 Session::keyframe_pose(int32_t keyframe) const {
  const Keyframe& asked = keyframes_[keyframe];
  if (!asked.retired()) return graph_.pose(asked.node);
  return submap_pose(submaps_[asked.owner]) * asked.T_owner_kf;
}

Status Session::pose(int32_t keyframe, PoseOutput* pose) const {
  if (keyframes_.gone(keyframe)) return Status::kRetired;
  if (!keyframes_.has(keyframe)) return Status::kInvalidArgument;
  const int32_t source = keyframes_.pose_source(keyframe);
  if (source < 0) return Status::kNotReady;
  const Keyframe& asked = keyframes_[keyframe];
  pose->T_world_kf = keyframe_pose(source);
  pose->timestamp_ns = asked.timestamp_ns;
  pose->state = asked.state;
  pose->confidence = asked.confidence();
  pose->submap = asked.best_submap;
  pose->segment = asked.segment;
  return Status::kOk;
}

}  // namespace unisim
