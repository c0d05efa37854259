// SPDX-License-Identifier: MIT
// What a finished run is known by.
#include "tools/replay/run_data.hpp"

#include <algorithm>

#include "drivers/pipeline/similarity.hpp"
#include "tools/common/failure.hpp"

namespace unisim::replay {
namespace {

std::vector<unisim_pose> read_poses(const unisim_session* session, int32_t keyframes) {
  std::vector<unisim_pose> poses(static_cast<size_t>(std::max(keyframes, 1)));
  for (unisim_pose& pose : poses) pose.struct_size = sizeof pose;
  size_t count = 0;
  const unisim_status status = unisim_get_trajectory(session, poses.data(), poses.size(), &count);
  if (status != UNISIM_OK) {
    throw tools::Failure(tools::kExitOther,
                         std::string("reading the trajectory: ") + unisim_status_string(status));
  }
  poses.resize(count);
  return poses;
}

double covariance_trace(unisim_session* session, int32_t keyframe) {
  double covariance[49];
  if (unisim_get_covariance(session, keyframe, covariance) != UNISIM_OK) return -1.0;
  double trace = 0.0;
  for (size_t k = 0; k < 49; k += 8) trace += covariance[k];
  return trace;
}

void add_between(const pipeline::Result& result, RunData* data) {
  data->frames = data->trajectory;
  for (const pipeline::BetweenPose& between : result.between) {
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

}  // namespace

RunData collect(unisim_session* session, const pipeline::Result& result, bool every_frame) {
  RunData data;
  data.session.struct_size = sizeof data.session;
  if (unisim_get_info(session, &data.session) != UNISIM_OK) return data;
  for (const unisim_pose& pose : read_poses(session, data.session.keyframes)) {
    const int64_t frame = result.keyframe_frames.at(static_cast<size_t>(pose.keyframe_id));
    data.keyframes.push_back({pose, frame, covariance_trace(session, pose.keyframe_id)});
    if (pose.confidence > 0) data.trajectory.push_back({pose.timestamp_ns, pose.T_world_kf});
  }
  for (const pipeline::LivePose& live : result.live) {
    data.live.push_back({live.timestamp_ns, live.T_world_cam});
  }
  if (every_frame) add_between(result, &data);
  return data;
}

}  // namespace unisim::replay
