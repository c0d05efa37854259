// SPDX-License-Identifier: MIT
// What a finished run is known by.
#include "tools/replay/run_data.hpp"

#include <algorithm>

#include "drivers/pipeline/similarity.hpp"

namespace unisim::replay {
namespace {

double covariance_trace(unisim_session* session, int32_t keyframe) {
  double covariance[49];
  if (unisim_get_covariance(session, keyframe, covariance) != UNISIM_OK) return -1.0;
  double trace = 0.0;
  for (size_t k = 0; k < 49; k += 8) trace += covariance[k];
  return trace;
}

void add_between(const RunRecord& record, RunData* data) {
  data->frames = data->trajectory;
  for (int64_t k = 0; k < record.between().size(); ++k) {
    const pipeline::BetweenPose between = record.between().get(k);
    const auto row =
        std::lower_bound(data->keyframes.begin(), data->keyframes.end(), between.keyframe_id,
                         [](const KeyframeRow& a, int32_t id) { return a.pose.keyframe_id < id; });
    if (row == data->keyframes.end() || row->pose.keyframe_id != between.keyframe_id) continue;
    data->frames.push_back(
        {between.timestamp_ns, pipeline::compose(row->pose.T_world_kf, between.T_kf_frame)});
  }
  std::sort(data->frames.begin(), data->frames.end(),
            [](const unisim_stamped_pose& a, const unisim_stamped_pose& b) {
              return a.timestamp_ns < b.timestamp_ns;
            });
}

void add_submaps(const unisim_session* session, const RunRecord& record, RunData* data) {
  for (int32_t id = 0; id < record.submaps(); ++id) {
    unisim_sim3 T_world_submap{};
    const bool known = record.poses().book().find_submap(session, id, &T_world_submap);
    data->submap_scale.push_back(known ? T_world_submap.s : 0.0);
  }
}

void add_earlier(const unisim_session* session, const RunRecord& record, int32_t keyframes,
                 RunData* data) {
  for (int32_t id = 0; id < keyframes; ++id) {
    unisim_pose pose{};
    if (!record.poses().read(session, id, &pose) || pose.confidence == 0) continue;
    data->map.push_back({pose.timestamp_ns, pose.T_world_kf});
  }
}

void take_away(const unisim_session_info& before, unisim_session_info* info) {
  info->keyframes -= before.keyframes;
  info->posed_keyframes -= before.posed_keyframes;
  info->submaps -= before.submaps;
  info->lost_events -= before.lost_events;
  info->pairs_refused -= before.pairs_refused;
  info->submaps_refused -= before.submaps_refused;
}

}  // namespace

RunData collect(unisim_session* session, const RunRecord& record, bool every_frame,
                const unisim_session_info& before) {
  RunData data;
  data.session.struct_size = sizeof data.session;
  if (unisim_get_info(session, &data.session) != UNISIM_OK) return data;
  add_earlier(session, record, before.keyframes, &data);
  for (int32_t id = before.keyframes; id < data.session.keyframes; ++id) {
    unisim_pose pose;
    if (!record.poses().read(session, id, &pose)) continue;
    data.keyframes.push_back({pose, record.frame_of(id), covariance_trace(session, id)});
    if (pose.confidence > 0) data.trajectory.push_back({pose.timestamp_ns, pose.T_world_kf});
  }
  data.map.insert(data.map.end(), data.trajectory.begin(), data.trajectory.end());
  take_away(before, &data.session);
  for (int64_t k = 0; k < record.live().size(); ++k) data.live.push_back(record.live().get(k));
  if (every_frame) add_between(record, &data);
  add_submaps(session, record, &data);
  return data;
}

}  // namespace unisim::replay
