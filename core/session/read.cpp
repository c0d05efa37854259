// SPDX-License-Identifier: MIT
// Results out, by copy.
#include "core/session.hpp"

namespace unisim {
namespace {

/// 0 held or unknown, 1 pair only, 2 in a submap, 3 in two or a closed loop.
int32_t confidence_of(const Keyframe& keyframe) {
  if (!keyframe.posed()) return 0;
  if (keyframe.loop_count > 0 || keyframe.window_count > 1) return 3;
  return keyframe.window_count == 1 ? 2 : 1;
}

}  // namespace

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
  if (!keyframes_.has(keyframe)) return Status::kInvalidArgument;
  const int32_t source = keyframes_.pose_source(keyframe);
  if (source < 0) return Status::kNotReady;
  const Keyframe& asked = keyframes_[keyframe];
  pose->T_world_kf = keyframe_pose(source);
  pose->timestamp_ns = asked.timestamp_ns;
  pose->state = asked.state;
  pose->confidence = confidence_of(asked);
  pose->submap = asked.best_submap;
  pose->segment = asked.segment;
  return Status::kOk;
}

}  // namespace unisim
