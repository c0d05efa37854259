// SPDX-License-Identifier: MIT
// Life cycle, data in, requests and optimisation: argument checks and calls into core.
#include "unisim/unisim.h"

#include <cmath>
#include <limits>

#include "capi/src/handle.hpp"
#include "capi/src/read_write.hpp"
#include "capi/src/struct_size.hpp"

using unisim::check_session;
using unisim::core;
using unisim::DepthMap;
using unisim::is_live;
using unisim::Session;
using unisim::Sim3;
using unisim::Span;
using unisim::Status;
using unisim::to_c;

static_assert(UNISIM_ERR_INVALID_ARGUMENT == static_cast<int>(Status::kInvalidArgument) &&
                  UNISIM_ERR_CAPACITY == static_cast<int>(Status::kCapacity) &&
                  UNISIM_ERR_OUT_OF_MEMORY == static_cast<int>(Status::kOutOfMemory) &&
                  UNISIM_ERR_NOT_READY == static_cast<int>(Status::kNotReady) &&
                  UNISIM_ERR_NUMERICAL == static_cast<int>(Status::kNumerical) &&
                  UNISIM_ERR_INTERNAL == static_cast<int>(Status::kInternal) &&
                  UNISIM_ERR_ABI_MISMATCH == static_cast<int>(Status::kAbiMismatch) &&
                  UNISIM_ERR_RETIRED == static_cast<int>(Status::kRetired) &&
                  UNISIM_ERR_IO == static_cast<int>(Status::kIo) &&
                  UNISIM_ERR_DATA == static_cast<int>(Status::kData),
              "status numbers");
static_assert(UNISIM_MAX_VIEWS == unisim::kMaxViews &&
                  UNISIM_REQUEST_PAIR == unisim::kRequestPair &&
                  UNISIM_REQUEST_WINDOW == unisim::kRequestWindow,
              "limits and bits");

namespace {

bool read_poses(const unisim_sim3* from, int32_t count, Sim3* to) {
  for (int32_t k = 0; k < count; ++k) {
    if (!unisim::read_pose(from[k], &to[k])) return false;
  }
  return true;
}

unisim_status add_submap(unisim_session* session, const unisim_submap* submap, bool is_loop,
                         int32_t* submap_id) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_submap s = {};
  status = unisim::read_struct(submap, &s);
  if (status != UNISIM_OK) return status;
  const bool complete = s.count >= 2 && s.count <= UNISIM_MAX_VIEWS && submap_id != nullptr &&
                        s.keyframe_ids != nullptr && s.T_submap_kf != nullptr &&
                        s.depth != nullptr && unisim::is_sigma(s.center_sigma);
  if (!complete) return UNISIM_ERR_INVALID_ARGUMENT;
  Sim3 poses[UNISIM_MAX_VIEWS];
  DepthMap depth[UNISIM_MAX_VIEWS];
  if (!read_poses(s.T_submap_kf, s.count, poses)) return UNISIM_ERR_INVALID_ARGUMENT;
  for (int32_t k = 0; k < s.count; ++k) {
    if (!unisim::read_depth(s.depth[k], &depth[k])) return UNISIM_ERR_INVALID_ARGUMENT;
  }
  const unisim::SubmapInput input = {
      {s.keyframe_ids, s.count}, {poses, s.count}, {depth, s.count}, s.center_sigma};
  return to_c(core(session)->add_submap(input, is_loop, submap_id));
}

}  // namespace

const char* unisim_status_string(unisim_status status) {
  switch (status) {
    case UNISIM_OK:
      return "ok";
    case UNISIM_ERR_INVALID_ARGUMENT:
      return "invalid argument";
    case UNISIM_ERR_CAPACITY:
      return "capacity exceeded";
    case UNISIM_ERR_OUT_OF_MEMORY:
      return "arena too small";
    case UNISIM_ERR_NOT_READY:
      return "not ready";
    case UNISIM_ERR_NUMERICAL:
      return "numerical failure";
    case UNISIM_ERR_INTERNAL:
      return "internal error";
    case UNISIM_ERR_ABI_MISMATCH:
      return "struct_size mismatch";
    case UNISIM_ERR_RETIRED:
      return "no longer kept";
    case UNISIM_ERR_IO:
      return "reading or writing failed";
    case UNISIM_ERR_DATA:
      return "not valid data";
    default:
      return "unknown status";
  }
}

int32_t unisim_version(void) { return UNISIM_VERSION_NUMBER; }

unisim_status unisim_session_create(unisim_session** session, const unisim_config* config,
                                    void* arena, size_t size) {
  if (session == nullptr || arena == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  unisim::SessionConfig checked;
  const unisim_status status = unisim::read_config(config, &checked);
  if (status != UNISIM_OK) return status;
  Session* made = nullptr;
  const Status created = Session::create(checked, arena, size, &made);
  if (created == Status::kOk) *session = reinterpret_cast<unisim_session*>(made);
  return to_c(created);
}

unisim_status unisim_session_reset(unisim_session* session) {
  return is_live(session) ? to_c(core(session)->reset()) : UNISIM_ERR_INVALID_ARGUMENT;
}

void unisim_session_destroy(unisim_session* session) {
  if (is_live(session)) core(session)->end();
}

unisim_status unisim_add_keyframe(unisim_session* session, const unisim_keyframe* keyframe,
                                  int32_t* id) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_keyframe k = {};
  status = unisim::read_struct(keyframe, &k);
  if (status != UNISIM_OK) return status;
  if (id == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  return to_c(core(session)->add_keyframe(k.timestamp_ns, id));
}

unisim_status unisim_add_two_view(unisim_session* session, const unisim_two_view* two_view) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_two_view t = {};
  status = unisim::read_struct(two_view, &t);
  if (status != UNISIM_OK) return status;
  unisim::TwoViewInput input;
  input.i = t.i;
  input.j = t.j;
  input.center_sigma = t.center_sigma;
  input.log_scale_sigma = t.log_scale_sigma;
  const bool good = unisim::read_pose(t.T_i_j, &input.T_i_j) &&
                    unisim::read_depth(t.depth_i, &input.depth_i) &&
                    unisim::read_depth(t.depth_j, &input.depth_j) &&
                    unisim::is_sigma(t.center_sigma) && unisim::is_sigma(t.log_scale_sigma);
  if (!good || t.i == std::numeric_limits<int32_t>::max()) return UNISIM_ERR_INVALID_ARGUMENT;
  return to_c(core(session)->add_two_view(input));
}

unisim_status unisim_add_submap(unisim_session* session, const unisim_submap* submap,
                                int32_t* submap_id) {
  return add_submap(session, submap, false, submap_id);
}

unisim_status unisim_add_loop(unisim_session* session, const unisim_submap* submap,
                              int32_t* submap_id) {
  return add_submap(session, submap, true, submap_id);
}

unisim_status unisim_update_submap(unisim_session* session, const unisim_submap_update* update) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_submap_update u = {};
  status = unisim::read_struct(update, &u);
  if (status != UNISIM_OK) return status;
  const bool complete = u.count >= 2 && u.count <= UNISIM_MAX_VIEWS && u.T_submap_kf != nullptr &&
                        u.log_depth_ratio != nullptr && unisim::is_sigma(u.center_sigma);
  if (!complete) return UNISIM_ERR_INVALID_ARGUMENT;
  Sim3 poses[UNISIM_MAX_VIEWS];
  if (!read_poses(u.T_submap_kf, u.count, poses)) return UNISIM_ERR_INVALID_ARGUMENT;
  constexpr double kLargestLogRatio = 20.0;  // beyond it the unit is lost, not another one
  for (int32_t k = 0; k < u.count; ++k) {
    if (!(std::abs(u.log_depth_ratio[k]) <= kLargestLogRatio)) return UNISIM_ERR_INVALID_ARGUMENT;
  }
  return to_c(core(session)->update_submap({u.submap_id,
                                            {poses, u.count},
                                            {u.log_depth_ratio, u.count},
                                            u.center_sigma,
                                            u.scale_settled == 1}));
}

unisim_status unisim_next_request(unisim_session* session, uint32_t kinds,
                                  unisim_request* request) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(request);
  if (status != UNISIM_OK) return status;
  constexpr uint32_t kKnown = UNISIM_REQUEST_PAIR | UNISIM_REQUEST_WINDOW | UNISIM_REQUEST_LOOP;
  if ((kinds & kKnown) == 0 || (kinds & ~kKnown) != 0) return UNISIM_ERR_INVALID_ARGUMENT;
  unisim::Request wanted;
  const Status found = core(session)->next_request(kinds, &wanted);
  if (found != Status::kOk) return to_c(found);
  unisim_request r = {};
  r.kind = wanted.kind;
  r.count = wanted.keyframes.count;
  for (int32_t k = 0; k < r.count; ++k) r.keyframe_ids[k] = wanted.keyframes.first + k;
  unisim::write_struct(r, unisim::struct_size_of(request), request);
  return UNISIM_OK;
}

unisim_status unisim_reject_request(unisim_session* session, const unisim_request* request) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_request r = {};
  status = unisim::read_struct(request, &r);
  if (status != UNISIM_OK) return status;
  if (r.count < 2 || r.count > UNISIM_MAX_VIEWS) return UNISIM_ERR_INVALID_ARGUMENT;
  const int64_t first = r.keyframe_ids[0];
  for (int32_t k = 0; k < r.count; ++k) {
    if (r.keyframe_ids[k] != first + k) return UNISIM_ERR_INVALID_ARGUMENT;
  }
  return to_c(core(session)->reject_request({r.kind, {r.keyframe_ids[0], r.count}}));
}

unisim_status unisim_close_window(unisim_session* session) {
  const unisim_status status = check_session(session);
  return status != UNISIM_OK ? status : to_c(core(session)->close_window());
}

unisim_status unisim_optimize(unisim_session* session, const unisim_budget* budget,
                              unisim_report* report) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_budget b = {};
  if (budget != nullptr) status = unisim::read_struct(budget, &b);
  if (status == UNISIM_OK && report != nullptr) status = unisim::check_output(report);
  if (status != UNISIM_OK) return status;
  if (b.max_iterations < 0) return UNISIM_ERR_INVALID_ARGUMENT;
  unisim::OptimizeReport done;
  const Status result = core(session)->optimize(b.max_iterations, &done);
  const bool reported = result == Status::kOk || result == Status::kNumerical;
  if (report == nullptr || !reported) return to_c(result);
  unisim_report r = {};
  r.stop = static_cast<int32_t>(done.lm.stop);
  r.iterations = done.lm.iterations;
  r.keyframes = done.keyframes;
  r.submaps = done.submaps;
  r.edges = core(session)->graph().edge_count();
  r.factor_blocks = static_cast<int32_t>(done.lm.factor_blocks);
  r.bad_node = done.bad_submap >= 0 ? -2 - done.bad_submap : done.bad_keyframe;
  r.initial_cost = done.lm.initial_cost;
  r.final_cost = done.lm.final_cost;
  r.map_revision = core(session)->counts().map_revision;
  r.first_changed = done.first_changed;
  r.last_changed = done.last_changed;
  r.jump_translation = done.jump_translation;
  r.jump_rotation_rad = done.jump_rotation;
  r.jump_log_scale = done.jump_log_scale;
  unisim::write_struct(r, unisim::struct_size_of(report), report);
  return to_c(result);
}
