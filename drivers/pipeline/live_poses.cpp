// SPDX-License-Identifier: MIT
// Gives out each pose as soon as it is known, once, to those who act by it.
#include "drivers/pipeline/live_poses.hpp"

#include "drivers/pipeline/similarity.hpp"

namespace unisim::pipeline {

void LivePoses::give_early(const unisim_frame& frame, int32_t id) {
  unisim_frame_pose place{};
  LivePose pose{};
  if (!pose_of_frame(frame, id, &place, &pose)) return;
  early_ = id;
  give(pose);
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
  unisim_frame_pose place{};
  LivePose pose{};
  if (!pose_of_frame(frame, -1, &place, &pose)) return;
  for (Listener* listener : *parts_.listeners) {
    listener->on_between_pose({frame.timestamp_ns, place.keyframe_id, place.T_kf_frame});
  }
  give(pose);
}

void LivePoses::give_located(const LocatedFrame& frame, int32_t segment) {
  give({frame.timestamp_ns, frame.T_world_cam, -1, segment, frame.metre});
}

/// Of the frame observed last, which is keyframe `id` or none (-1): its place under the keyframe
/// that holds it, and its pose. @return false: not known
bool LivePoses::pose_of_frame(const unisim_frame& frame, int32_t id, unisim_frame_pose* place,
                              LivePose* pose) {
  unisim_predictor* predictor = parts_.predictor;
  if (predictor->frame_pose == nullptr) return false;
  if (predictor->frame_pose(predictor, place) != UNISIM_PREDICTION_OK) return false;
  unisim_pose holder{};
  if (parts_.session->get_pose(place->keyframe_id, &holder) != UNISIM_OK) return false;
  if (holder.confidence <= 0) return false;
  *pose = {frame.timestamp_ns, compose(holder.T_world_kf, place->T_kf_frame), id, holder.segment,
           metre(holder.segment)};
  return true;
}

void LivePoses::give(const LivePose& pose) {
  any_ = true;
  parts_.progress->metre = pose.metre;
  for (Listener* listener : *parts_.listeners) listener->on_live_pose(pose);
}

}  // namespace unisim::pipeline
