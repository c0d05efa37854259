// SPDX-License-Identifier: MIT
// Poses that a session has streamed out, put together again after later corrections.
#include "drivers/pipeline/pose_book.hpp"

#include "drivers/pipeline/similarity.hpp"

namespace unisim::pipeline {

void PoseBook::take(const unisim_retired& retired) {
  if (retired.kind == UNISIM_RETIRED_KEYFRAME) {
    keyframes_.put(retired.keyframe_id, {retired.submap_id, retired.T});
  } else {
    submaps_.put(retired.submap_id, {retired.anchor_id, retired.T});
  }
}

bool PoseBook::find(const unisim_session* session, int32_t keyframe,
                    unisim_sim3* T_world_kf) const {
  const Place place = keyframes_.get(keyframe);
  unisim_sim3 T_world_submap{};
  if (place.carrier < 0 || !find_submap(session, place.carrier, &T_world_submap)) return false;
  *T_world_kf = compose(T_world_submap, place.T);
  return true;
}

bool PoseBook::find_submap(const unisim_session* session, int32_t submap,
                           unisim_sim3* T_world_submap) const {
  unisim_sim3 T_anchor_submap = {{0, 0, 0, 1}, {0, 0, 0}, 1};
  int32_t anchor = submap;
  for (Place place = submaps_.get(anchor); place.carrier >= 0; place = submaps_.get(anchor)) {
    T_anchor_submap = compose(place.T, T_anchor_submap);
    anchor = place.carrier;
  }
  unisim_submap_info info{};
  info.struct_size = sizeof info;
  if (unisim_get_submap(session, anchor, &info) != UNISIM_OK) return false;
  *T_world_submap = compose(info.T_world_submap, T_anchor_submap);
  return true;
}

}  // namespace unisim::pipeline
