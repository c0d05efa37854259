// SPDX-License-Identifier: MIT
// What leaves the window, and how loops stand: argument checks and calls into core.
#include "capi/src/handle.hpp"
#include "capi/src/read_write.hpp"
#include "capi/src/struct_size.hpp"

using unisim::check_session;
using unisim::core;
using unisim::LoopState;
using unisim::Status;
using unisim::to_c;

static_assert(UNISIM_LOOP_ACTIVE == static_cast<int>(LoopState::kActive) &&
                  UNISIM_LOOP_SUSPENDED == static_cast<int>(LoopState::kSuspended) &&
                  UNISIM_LOOP_RIGID == static_cast<int>(LoopState::kRigid) &&
                  UNISIM_LOOP_REMOVED == static_cast<int>(LoopState::kRemoved),
              "loop states");

unisim_status unisim_next_retired(unisim_session* session, unisim_retired* retired) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(retired);
  if (status != UNISIM_OK) return status;
  unisim::Retired next;
  const Status found = core(session)->next_retired(&next);
  if (found != Status::kOk) return to_c(found);
  unisim_retired r = {};
  r.kind = next.keyframe >= 0 ? UNISIM_RETIRED_KEYFRAME : UNISIM_RETIRED_SUBMAP;
  r.keyframe_id = next.keyframe;
  r.submap_id = next.submap;
  r.anchor_id = next.anchor;
  r.confidence = next.confidence;
  r.segment = next.segment;
  r.timestamp_ns = next.timestamp_ns;
  r.T = unisim::write_pose(next.T);
  unisim::write_struct(r, unisim::struct_size_of(retired), retired);
  return UNISIM_OK;
}

unisim_status unisim_remove_loop(unisim_session* session, int32_t submap_id) {
  const unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  return to_c(core(session)->remove_loop(submap_id));
}

unisim_status unisim_get_loop(const unisim_session* session, int32_t submap_id,
                              unisim_loop_info* info) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(info);
  if (status != UNISIM_OK) return status;
  unisim::LoopStatus loop;
  const Status found = core(session)->loop_status(submap_id, &loop);
  if (found != Status::kOk) return to_c(found);
  unisim_loop_info i = {};
  i.submap_id = submap_id;
  i.state = static_cast<int32_t>(loop.state);
  i.condensed = loop.condensed ? 1 : 0;
  i.residual = loop.norm;
  unisim::write_struct(i, unisim::struct_size_of(info), info);
  return UNISIM_OK;
}
