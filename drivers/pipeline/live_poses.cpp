// SPDX-License-Identifier: MIT
// Gives out each pose as soon as it is known, once, to those who act by it.
#include "drivers/pipeline/live_poses.hpp"

#include "drivers/pipeline/similarity.hpp"

namespace unisim::pipeline {

void LivePoses::give_early(const unisim_frame& frame, int32_t id) {
  unisim_frame_pose between{};
  unisim_pose held{};
  if (!pose_of_frame(&between, &held)) return;
  early_ = id;
  give({frame.timestamp_ns, compose(held.T_world_kf, between.T_kf_frame), id, held.segment,
        metre(held.segment)});
}

void LivePoses::give_keyframes(bool ending) {
  if (parts_.map->last_settled() == 0) return;
  for (; next_ <= parts_.map->last_settled(); ++next_) {
    unisim_pose pose{};
    // A held pose (confidence 0) is the old one repeated, not a pose of this keyframe.
    if (parts_.session->get_pose(next_, &pose) != UNISIM_OK || pose.confidence == 0) continue;
    if (next_ != early_) {
      const bool late = ending || pose.timestamp_ns != parts_.progress->newest_ns;
      give({pose.timestamp_ns, pose.T_world_kf, next_, pose.segment, metre(pose.segment),
            parts_.at_clock && late});
    }
    for (Listener* listener : *parts_.listeners) listener->on_keyframe_pose(pose);
  }
}

void LivePoses::give_between(const unisim_frame& frame) {
  unisim_frame_pose between{};
  unisim_pose held{};
  if (!pose_of_frame(&between, &held)) return;
  for (Listener* listener : *parts_.listeners) {
    listener->on_between_pose({frame.timestamp_ns, between.keyframe_id, between.T_kf_frame});
  }
  give({frame.timestamp_ns, compose(held.T_world_kf, between.T_kf_frame), -1, held.segment,
        metre(held.segment)});
}

void LivePoses::give_located(const LocatedFrame& frame, int32_t segment) {
  give({frame.timestamp_ns, frame.T_world_cam, -1, segment, frame.metre});
}

/// Pose of the frame observed last, and of the keyframe that holds it. @return false: none
bool LivePoses::pose_of_frame(unisim_frame_pose* between, unisim_pose* held) {
  unisim_predictor* predictor = parts_.predictor;
  if (predictor->frame_pose == nullptr) return false;
  if (predictor->frame_pose(predictor, between) != UNISIM_PREDICTION_OK) return false;
  return parts_.session->get_pose(between->keyframe_id, held) == UNISIM_OK && held->confidence > 0;
}

void LivePoses::give(const LivePose& pose) {
  any_ = true;
  parts_.progress->metre = pose.metre;
  for (Listener* listener : *parts_.listeners) listener->on_live_pose(pose);
}

}  // namespace unisim::pipeline
