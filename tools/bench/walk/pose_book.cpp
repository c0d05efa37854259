// SPDX-License-Identifier: MIT
// Poses that a session has streamed out, put together again after later corrections.
#include "tools/bench/walk/pose_book.hpp"

#include <Eigen/Geometry>

namespace unisim::bench {
namespace {

// T_a_c = T_a_b * T_b_c.
unisim_sim3 compose(const unisim_sim3& T_a_b, const unisim_sim3& T_b_c) {
  const Eigen::Map<const Eigen::Quaterniond> q_a_b(T_a_b.q);
  const Eigen::Map<const Eigen::Quaterniond> q_b_c(T_b_c.q);
  unisim_sim3 T{};
  Eigen::Map<Eigen::Quaterniond>(T.q) = (q_a_b * q_b_c).normalized();
  const Eigen::Map<const Eigen::Vector3d> t_a_b(T_a_b.t);
  const Eigen::Map<const Eigen::Vector3d> t_b_c(T_b_c.t);
  Eigen::Map<Eigen::Vector3d>(T.t) = T_a_b.s * (q_a_b * t_b_c) + t_a_b;
  T.s = T_a_b.s * T_b_c.s;
  return T;
}

}  // namespace

void PoseBook::put(std::vector<Place>* places, int32_t id, const Place& place) {
  const auto at = static_cast<size_t>(id);
  if (places->size() <= at) places->resize(at + 1);
  (*places)[at] = place;
}

void PoseBook::read(unisim_session* session) {
  unisim_retired retired{};
  retired.struct_size = sizeof retired;
  while (unisim_next_retired(session, &retired) == UNISIM_OK) {
    if (retired.kind == UNISIM_RETIRED_KEYFRAME) {
      put(&keyframes_, retired.keyframe_id, {retired.submap_id, retired.T});
    } else {
      put(&submaps_, retired.submap_id, {retired.anchor_id, retired.T});
    }
  }
}

bool PoseBook::find(const unisim_session* session, int32_t keyframe,
                    unisim_sim3* T_world_kf) const {
  const auto at = static_cast<size_t>(keyframe);
  if (at >= keyframes_.size() || keyframes_[at].carrier < 0) return false;
  unisim_sim3 T = keyframes_[at].T;
  auto submap = static_cast<size_t>(keyframes_[at].carrier);
  while (submap < submaps_.size() && submaps_[submap].carrier >= 0) {
    T = compose(submaps_[submap].T, T);
    submap = static_cast<size_t>(submaps_[submap].carrier);
  }
  unisim_submap_info anchor{};
  anchor.struct_size = sizeof anchor;
  if (unisim_get_submap(session, static_cast<int32_t>(submap), &anchor) != UNISIM_OK) return false;
  *T_world_kf = compose(anchor.T_world_submap, T);
  return true;
}

}  // namespace unisim::bench
