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

void add_sigmas(unisim_session* session, RunData* data) {
  std::vector<unisim_pose> poses;
  for (const KeyframeRow& row : data->keyframes) poses.push_back(row.pose);
  const std::vector<PoseSigma> sigmas = pose_sigmas(session, poses);
  for (size_t k = 0; k < sigmas.size(); ++k) data->keyframes[k].sigma = sigmas[k];
}

void take_away(const unisim_session_info& before, unisim_session_info* info) {
  info->keyframes -= before.keyframes;
  info->posed_keyframes -= before.posed_keyframes;
  info->submaps -= before.submaps;
  info->lost_events -= before.lost_events;
  info->pairs_refused -= before.pairs_refused;
  info->submaps_refused -= before.submaps_refused;
}

const SegmentScale* scale_of(const RunData& data, int32_t segment) {
  for (const SegmentScale& scale : data.scales) {
    if (scale.segment == segment) return &scale;
  }
  return nullptr;
}

/// What is known of the scale of each segment that has keyframes.
void ask_scales(unisim_session* session, RunData* data) {
  data->metric = !data->keyframes.empty();
  std::vector<int32_t> asked;
  for (const KeyframeRow& row : data->keyframes) {
    const int32_t segment = row.pose.segment;
    if (segment < 0 || std::find(asked.begin(), asked.end(), segment) != asked.end()) continue;
    asked.push_back(segment);
    unisim_scale scale{};
    scale.struct_size = sizeof scale;
    if (unisim_get_scale(session, segment, &scale) != UNISIM_OK) {
      data->metric = false;
      continue;
    }
    data->scales.push_back({segment, scale.metres_per_unit, scale.sigma});
    data->distances = scale;
  }
}

/// A submap is where its keyframes are.
double metres_of_submap(const RunData& data, int32_t submap) {
  for (const KeyframeRow& row : data.keyframes) {
    const SegmentScale* scale = scale_of(data, row.pose.segment);
    if (row.pose.submap_id == submap && scale != nullptr) return scale->metres_per_unit;
  }
  return data.main_scale()->metres_per_unit;
}

/// The map's unit becomes the metre: p' = s p for all points of the world.
void to_metres(RunData* data) {
  double metres = data->main_scale()->metres_per_unit;  // of a held pose: as the one before it
  for (KeyframeRow& row : data->keyframes) {
    const SegmentScale* scale = scale_of(*data, row.pose.segment);
    if (scale != nullptr) metres = scale->metres_per_unit;
    for (double& t : row.pose.T_world_kf.t) t *= metres;
    row.pose.T_world_kf.s *= metres;
    row.sigma.position *= metres;
  }
  for (size_t id = 0; id < data->submap_scale.size(); ++id) {
    data->submap_scale[id] *= metres_of_submap(*data, static_cast<int32_t>(id));
  }
}

}  // namespace

const SegmentScale* RunData::main_scale() const {
  const SegmentScale* best = nullptr;
  int64_t most = -1;
  for (const SegmentScale& scale : scales) {
    const auto count =
        std::count_if(keyframes.begin(), keyframes.end(),
                      [&](const KeyframeRow& row) { return row.pose.segment == scale.segment; });
    if (count > most) {
      most = count;
      best = &scale;
    }
  }
  return metric ? best : nullptr;
}

RunData collect(unisim_session* session, const RunRecord& record, bool every_frame,
                const unisim_session_info& before) {
  RunData data;
  data.session.struct_size = sizeof data.session;
  if (unisim_get_info(session, &data.session) != UNISIM_OK) return data;
  add_earlier(session, record, before.keyframes, &data);
  for (int32_t id = before.keyframes; id < data.session.keyframes; ++id) {
    unisim_pose pose;
    if (!record.poses().read(session, id, &pose)) continue;
    data.keyframes.push_back(
        {pose, record.frame_of(id), covariance_trace(session, id), record.reason_of(id)});
  }
  add_sigmas(session, &data);
  add_submaps(session, record, &data);
  ask_scales(session, &data);
  if (data.metric) to_metres(&data);
  for (const KeyframeRow& row : data.keyframes) {
    const unisim_pose& pose = row.pose;
    if (pose.confidence > 0) data.trajectory.push_back({pose.timestamp_ns, pose.T_world_kf});
  }
  const double map_unit = data.metric ? data.main_scale()->metres_per_unit : 1.0;
  const auto in_unit = [map_unit](unisim_stamped_pose pose) {
    for (double& t : pose.T_world_cam.t) t *= map_unit;
    return pose;
  };
  for (unisim_stamped_pose& pose : data.map) pose = in_unit(pose);
  data.map.insert(data.map.end(), data.trajectory.begin(), data.trajectory.end());
  take_away(before, &data.session);
  for (int64_t k = 0; k < record.live().size(); ++k) {
    data.live.push_back(in_unit(record.live().get(k)));
  }
  if (every_frame) add_between(record, &data);
  return data;
}

}  // namespace unisim::replay
