// SPDX-License-Identifier: MIT
// Poses of single frames in the world of a session's map.
#include "drivers/pipeline/localiser.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/common/median.hpp"
#include "drivers/pipeline/similarity.hpp"

namespace unisim::pipeline {
namespace {

// Keyframes nearer to each other than this share of the longest distance say little on the scale.
constexpr double kFarEnough = 0.25;

}  // namespace

Localiser::Localiser(const unisim_session* session, unisim_predictor* predictor) {
  unisim_session_info info{};
  info.struct_size = sizeof info;
  if (unisim_get_info(session, &info) != UNISIM_OK) return;
  for (int32_t id = info.first_keyframe; id < info.keyframes; ++id) {
    unisim_pose here{};
    here.struct_size = sizeof here;
    unisim_map_pose there{};
    if (unisim_get_pose(session, id, &here) != UNISIM_OK || here.confidence == 0) continue;
    if (predictor->map_pose(predictor, id, &there) != UNISIM_PREDICTION_OK) continue;
    here.T_world_kf.s = 1.0;
    keyframes_.push_back({id, here.segment, there.segment, here.T_world_kf, there.T_map_kf, 0.0});
  }
  for (Common& keyframe : keyframes_) keyframe.scale = scale_at(keyframe);
}

/// From distances to the keyframes that are far away: the median, since a map may bend.
double Localiser::scale_at(const Common& keyframe) const {
  const auto comparable = [&](const Common& other) {
    return other.segment == keyframe.segment && other.map_segment == keyframe.map_segment;
  };
  double farthest = 0.0;
  for (const Common& other : keyframes_) {
    if (comparable(other))
      farthest = std::max(farthest, distance(other.T_map_kf.t, keyframe.T_map_kf.t));
  }
  std::vector<double> ratios;
  for (const Common& other : keyframes_) {
    const double there = distance(other.T_map_kf.t, keyframe.T_map_kf.t);
    if (!comparable(other) || !(there > kFarEnough * farthest)) continue;
    ratios.push_back(distance(other.T_world_kf.t, keyframe.T_world_kf.t) / there);
  }
  return ratios.empty() ? 0.0 : drivers::median(&ratios);
}

bool Localiser::pose(const unisim_location& found, unisim_sim3* T_world_cam,
                     int32_t* segment) const {
  const Common* nearest = nullptr;
  for (const Common& keyframe : keyframes_) {
    if (keyframe.map_segment != found.segment || !(keyframe.scale > 0.0)) continue;
    const bool nearer = nearest == nullptr || std::abs(keyframe.id - found.keyframe_id) <
                                                  std::abs(nearest->id - found.keyframe_id);
    if (nearer) nearest = &keyframe;
  }
  if (nearest == nullptr) return false;
  unisim_sim3 T_world_kf = nearest->T_world_kf;
  T_world_kf.s = nearest->scale;
  *segment = nearest->segment;
  *T_world_cam = compose(T_world_kf, compose(inverse(nearest->T_map_kf), found.T_map_frame));
  return true;
}

}  // namespace unisim::pipeline
