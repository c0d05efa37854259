// SPDX-License-Identifier: MIT
// The small messages: pose, keyframe, correction, status.
#include <cmath>
#include <cstddef>
#include <cstring>

#include "drivers/lcm/publisher_state.hpp"
#include "unisim_correction_t.h"
#include "unisim_keyframe_t.h"
#include "unisim_pose_t.h"
#include "unisim_status_t.h"

using unisim::lcm::is_pose;
using unisim::lcm::microseconds;
using unisim::lcm::put;
using unisim::lcm::put_pose;

namespace {

constexpr size_t kLongestStageName = 63;

/// Variances of a 7x7 covariance; -1 where it is not known.
void put_variances(const double covariance[49], double out[7]) {
  for (int k = 0; k < 7; ++k) out[k] = covariance != nullptr ? covariance[8 * k] : -1.0;
}

bool good_stages(const unisim_lcm_status& status) {
  if (status.stage_count < 0 || status.stage_count > UNISIM_LCM_MAX_STAGES) return false;
  if (status.stage_count > 0 && status.stages == nullptr) return false;
  for (int32_t i = 0; i < status.stage_count; ++i) {
    const char* name = status.stages[i].name;
    if (name == nullptr || std::strlen(name) > kLongestStageName) return false;
  }
  return true;
}

}  // namespace

int unisim_lcm_publisher_set_unit(unisim_lcm_publisher* publisher, int32_t unit,
                                  double scale_sigma) {
  const bool metric = unit == UNISIM_LCM_UNIT_METRIC;
  if (publisher == nullptr || (!metric && unit != UNISIM_LCM_UNIT_RELATIVE) ||
      !std::isfinite(scale_sigma) || scale_sigma < 0.0) {
    return UNISIM_LCM_REFUSED;
  }
  publisher->unit = unit;
  publisher->scale_sigma = metric ? scale_sigma : 0.0;
  return UNISIM_LCM_QUEUED;
}

int unisim_lcm_publish_pose(unisim_lcm_publisher* publisher, int64_t timestamp_ns,
                            const unisim_sim3* T_world_cam) {
  if (publisher == nullptr || T_world_cam == nullptr || !is_pose(*T_world_cam)) {
    return UNISIM_LCM_REFUSED;
  }
  unisim_pose_t out{};
  out.utime = microseconds(timestamp_ns);
  put_pose(*T_world_cam, out.pos, out.orientation);
  return put(publisher, "UNISIM_POSE", out, unisim_pose_t_encoded_size, unisim_pose_t_encode);
}

int unisim_lcm_publish_keyframe(unisim_lcm_publisher* publisher, const unisim_pose* pose,
                                int32_t map_revision, const double covariance[49]) {
  if (publisher == nullptr || pose == nullptr || pose->struct_size < sizeof *pose ||
      !is_pose(pose->T_world_kf)) {
    return UNISIM_LCM_REFUSED;
  }
  unisim_keyframe_t out{};
  out.utime = microseconds(pose->timestamp_ns);
  out.id = pose->keyframe_id;
  out.map_revision = map_revision;
  put_pose(pose->T_world_kf, out.pos, out.orientation);
  out.scale = pose->T_world_kf.s;
  put_variances(covariance, out.covariance);
  out.confidence = pose->confidence;
  out.state = pose->state;
  out.submap = pose->submap_id;
  out.segment = pose->segment;
  out.unit = publisher->unit;
  out.scale_sigma = publisher->scale_sigma;
  return put(publisher, "UNISIM_KEYFRAME", out, unisim_keyframe_t_encoded_size,
             unisim_keyframe_t_encode);
}

int unisim_lcm_publish_correction(unisim_lcm_publisher* publisher,
                                  const unisim_lcm_correction* correction) {
  if (publisher == nullptr || correction == nullptr ||
      correction->struct_size < sizeof *correction || !is_pose(correction->T_new_old)) {
    return UNISIM_LCM_REFUSED;
  }
  unisim_correction_t out{};
  out.utime = microseconds(correction->timestamp_ns);
  out.map_revision = correction->map_revision;
  out.keyframe = correction->keyframe_id;
  out.segment = correction->segment;
  put_pose(correction->T_new_old, out.jump_pos, out.jump_orientation);
  out.jump_scale = correction->T_new_old.s;
  out.first_changed = correction->first_changed;
  out.last_changed = correction->last_changed;
  out.unit = publisher->unit;
  out.scale_sigma = publisher->scale_sigma;
  return put(publisher, "UNISIM_CORRECTION", out, unisim_correction_t_encoded_size,
             unisim_correction_t_encode);
}

/// Of a program built before there were reasons.
constexpr size_t kFirstStatusSize = offsetof(unisim_lcm_status, reason);

int unisim_lcm_publish_status(unisim_lcm_publisher* publisher, const unisim_lcm_status* status) {
  if (publisher == nullptr || status == nullptr || status->struct_size < kFirstStatusSize ||
      !good_stages(*status)) {
    return UNISIM_LCM_REFUSED;
  }
  for (int32_t i = 0; i < status->stage_count; ++i) {
    const unisim_lcm_stage& stage = status->stages[i];
    // Encoding reads the name and nothing else of it.
    publisher->stages[static_cast<size_t>(i)] = {const_cast<char*>(stage.name), stage.count,
                                                 stage.p50_ms, stage.p95_ms, stage.max_ms};
  }
  unisim_status_t out{};
  out.utime = microseconds(status->timestamp_ns);
  out.state = status->state;
  out.reason = status->struct_size >= sizeof *status ? status->reason : UNISIM_STATUS_T_REASON_NONE;
  out.unit = publisher->unit;
  out.scale_sigma = publisher->scale_sigma;
  out.confidence = status->confidence;
  out.keyframe = status->keyframe_id;
  out.segment = status->segment;
  out.map_revision = status->map_revision;
  out.frames = status->frames;
  out.frames_bad = status->frames_bad;
  out.frames_dropped = status->frames_dropped;
  out.queue_depth = status->queue_depth;
  out.keyframes = status->keyframes;
  out.submaps = status->submaps;
  out.loops = status->loops;
  out.lost_events = status->lost_events;
  out.messages_dropped = publisher->queue->counts().dropped;
  out.n = status->stage_count;
  out.stages = publisher->stages.data();
  return put(publisher, "UNISIM_STATUS", out, unisim_status_t_encoded_size, unisim_status_t_encode);
}
