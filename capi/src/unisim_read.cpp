// SPDX-License-Identifier: MIT
// Results out, by copy.
#include <algorithm>

#include "capi/src/handle.hpp"
#include "capi/src/read_write.hpp"
#include "capi/src/struct_size.hpp"

using unisim::check_session;
using unisim::core;
using unisim::PoseOutput;
using unisim::PredictionKind;
using unisim::RefusalReason;
using unisim::Session;
using unisim::Status;
using unisim::to_c;
using unisim::Tracking;

static_assert(UNISIM_STATE_INIT == static_cast<int>(Tracking::kInit) &&
                  UNISIM_STATE_TRACKING == static_cast<int>(Tracking::kTracking) &&
                  UNISIM_STATE_DEGRADED == static_cast<int>(Tracking::kDegraded) &&
                  UNISIM_STATE_LOST == static_cast<int>(Tracking::kLost) &&
                  UNISIM_STATE_RELOCALISED == static_cast<int>(Tracking::kRelocalised),
              "state numbers");

static_assert(UNISIM_REFUSED_NONE == static_cast<int>(RefusalReason::kNone) &&
                  UNISIM_REFUSED_SIGMA == static_cast<int>(RefusalReason::kSigma) &&
                  UNISIM_REFUSED_SCATTER == static_cast<int>(RefusalReason::kScatter) &&
                  UNISIM_REFUSED_VIEWS == static_cast<int>(RefusalReason::kViews) &&
                  UNISIM_REFUSED_RANGE == static_cast<int>(RefusalReason::kRange) &&
                  UNISIM_REFUSED_HOST == static_cast<int>(RefusalReason::kHost) &&
                  UNISIM_REFUSED_ROOM == static_cast<int>(RefusalReason::kRoom) &&
                  UNISIM_REFUSED_LATE == static_cast<int>(RefusalReason::kLate),
              "reasons of refusals");

namespace {

unisim_pose to_c(int32_t keyframe_id, const PoseOutput& pose) {
  unisim_pose p = {};
  p.keyframe_id = keyframe_id;
  p.timestamp_ns = pose.timestamp_ns;
  p.T_world_kf = unisim::write_pose(pose.T_world_kf);
  p.state = static_cast<int32_t>(pose.state);
  p.confidence = pose.confidence;
  p.submap_id = pose.submap;
  p.segment = pose.segment;
  return p;
}

unisim_refusal newest_refusal(const Session& session, unisim::PredictionKind kind) {
  const unisim::Refusal& newest = session.refusals().newest(kind);
  unisim_refusal r = {};
  r.reason = static_cast<int32_t>(newest.reason);
  r.first_keyframe = newest.first_keyframe;
  r.last_keyframe = newest.last_keyframe;
  r.value = newest.value;
  r.limit = newest.limit;
  return r;
}

}  // namespace

unisim_status unisim_get_pose(const unisim_session* session, int32_t keyframe_id,
                              unisim_pose* pose) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(pose);
  if (status != UNISIM_OK) return status;
  PoseOutput latest;
  const Status found = core(session)->pose(keyframe_id, &latest);
  if (found != Status::kOk) return to_c(found);
  unisim::write_struct(to_c(keyframe_id, latest), unisim::struct_size_of(pose), pose);
  return UNISIM_OK;
}

unisim_status unisim_get_trajectory(const unisim_session* session, unisim_pose* poses,
                                    size_t capacity, size_t* count) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  if (count == nullptr || (poses == nullptr && capacity > 0)) return UNISIM_ERR_INVALID_ARGUMENT;
  if (capacity > 0) status = unisim::check_output(poses);
  if (status != UNISIM_OK) return status;
  const Session& source = *core(session);
  size_t needed = 0;
  const int32_t first = source.keyframes().first();
  const int32_t end = source.keyframes().size();
  for (int32_t id = first; id < end; ++id) needed += source.has_pose(id) ? 1 : 0;
  *count = needed;
  if (needed > capacity) return UNISIM_ERR_CAPACITY;
  if (needed == 0) return UNISIM_OK;
  const size_t stride = unisim::struct_size_of(poses);
  auto* place = reinterpret_cast<unsigned char*>(poses);
  for (int32_t id = first; id < end; ++id) {
    PoseOutput latest;
    if (source.pose(id, &latest) != Status::kOk) continue;
    unisim::write_struct(to_c(id, latest), stride, place);
    place += stride;
  }
  return UNISIM_OK;
}

unisim_status unisim_get_covariance(unisim_session* session, int32_t keyframe_id,
                                    double covariance[49]) {
  const unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  if (covariance == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  unisim::Mat7 block;
  const Status done = core(session)->covariance(keyframe_id, &block);
  if (done == Status::kOk) std::copy(block.data(), block.data() + block.size(), covariance);
  return to_c(done);
}

unisim_status unisim_multiply_covariance(unisim_session* session, int32_t first_keyframe,
                                         int32_t count, const double* weights, double* products) {
  const unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  if (weights == nullptr || products == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  return to_c(core(session)->multiply_covariance(first_keyframe, count, weights, products));
}

unisim_status unisim_get_submap(const unisim_session* session, int32_t submap_id,
                                unisim_submap_info* info) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(info);
  if (status != UNISIM_OK) return status;
  const Session& source = *core(session);
  if (source.submaps().gone(submap_id)) return UNISIM_ERR_RETIRED;
  if (!source.submaps().has(submap_id)) return UNISIM_ERR_INVALID_ARGUMENT;
  const unisim::Submap& submap = source.submaps()[submap_id];
  unisim_submap_info s = {};
  s.submap_id = submap_id;
  s.is_loop = submap.is_loop ? 1 : 0;
  s.count = submap.count;
  for (int32_t k = 0; k < submap.count; ++k) {
    s.keyframe_ids[k] = source.submaps().keyframe(submap, k);
  }
  s.T_world_submap = unisim::write_pose(source.submap_pose(submap));
  s.center_sigma = submap.quality.center_sigma;
  s.scatter = submap.quality.scatter;
  unisim::write_struct(s, unisim::struct_size_of(info), info);
  return UNISIM_OK;
}

unisim_status unisim_get_info(const unisim_session* session, unisim_session_info* info) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(info);
  if (status != UNISIM_OK) return status;
  const Session& source = *core(session);
  const unisim::SessionCounts& counts = source.counts();
  const unisim::Skeleton& skeleton = source.skeleton();
  const unisim::LoopWatch& watch = source.loop_watch();
  unisim_session_info i = {};
  i.state = static_cast<int32_t>(source.tracking().state());
  i.keyframes = source.keyframes().size();
  i.posed_keyframes = counts.posed_keyframes;
  i.last_posed = counts.last_posed;
  i.submaps = counts.windows;
  i.submaps_refused = source.refusals().count(PredictionKind::kWindow);
  i.loops = counts.loops;
  i.loops_refused = source.refusals().count(PredictionKind::kLoop);
  i.pairs_refused = source.refusals().count(PredictionKind::kPair);
  i.segments = counts.segments;
  i.lost_events = source.tracking().lost_events();
  i.map_revision = counts.map_revision;
  i.arena_bytes = source.arena_bytes();
  i.arena_peak_bytes = source.arena_used_bytes();
  i.first_keyframe = source.keyframes().first();
  i.retired_keyframes = skeleton.counts().keyframes;
  i.retired_unread = skeleton.unread();
  i.stretches = skeleton.counts().stretches;
  i.suspended_loops = watch.suspended();
  i.loop_suspensions = watch.suspensions();
  i.loop_returns = watch.returns();
  i.loops_removed = skeleton.counts().loops_removed;
  i.loops_dropped = skeleton.loop_edges().dropped_loops();
  i.refused_pair = newest_refusal(source, PredictionKind::kPair);
  i.refused_window = newest_refusal(source, PredictionKind::kWindow);
  i.refused_loop = newest_refusal(source, PredictionKind::kLoop);
  unisim::write_struct(i, unisim::struct_size_of(info), info);
  return UNISIM_OK;
}
