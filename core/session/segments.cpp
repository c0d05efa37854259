// SPDX-License-Identifier: MIT
// Where a submap comes to lie, and segments that it joins.
#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/graph/bridge.hpp"
#include "core/session.hpp"

namespace unisim {

/// S_m = [(s_o / rho_mo) R_o, t_o] of its origin.
Sim3 Session::first_pose(const Submap& submap) const {
  const SubmapView& origin = map_.submaps.view(submap, submap.origin);
  return map_.keyframe_pose(origin.keyframe) * Sim3::scaling(math::exp(-origin.log_rho));
}

/// Segments that its other views belong to follow.
void Session::place_submap(Submap* submap) {
  const SubmapView& origin = map_.submaps.view(*submap, submap->origin);
  if (!holds(map_.graph.add_node(NodeKind::kSubmap, first_pose(*submap), &submap->place.node)))
    return;
  for (int32_t k = 0; k < submap->count; ++k) {
    const SubmapView& view = map_.submaps.view(*submap, k);
    if (view.measured && map_.keyframes[view.keyframe].segment != origin.segment) {
      watch_.note_news();
      join_segment(*submap, map_.keyframes[view.keyframe].segment, origin.segment);
      if (submap->is_loop) tracking_.relocalised();
    }
  }
}

/// View by which a submap joins a segment to its own: the one nearest to its centre.
const SubmapView& Session::joining_view(const Submap& submap, int32_t segment) const {
  const int32_t centre = submap.count / 2;
  int32_t best = -1;
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = map_.submaps.view(submap, k);
    if (!view.measured || map_.keyframes[view.keyframe].segment != segment) continue;
    if (best < 0 || std::abs(k - centre) < std::abs(best - centre)) best = k;
  }
  return map_.submaps.view(submap, best);
}

/// How the view's segment has to move for the view to lie where the submap sees it.
Sim3 Session::join_correction(const SubmapView& view, const Sim3& T_world_submap) const {
  const Sim3 T_world_kf =
      T_world_submap * bridge_measurement(view.T_submap_kf, math::exp(view.log_rho));
  return T_world_kf * map_.keyframe_pose(view.keyframe).inverse();
}

/// Would all that follows a submap into its segment stay within the range of numbers?
bool Session::joins_in_range(const Submap& submap, const Sim3& T_world_submap,
                             int32_t segment) const {
  if (segment == submap.segment) return true;
  const Sim3 correction = join_correction(joining_view(submap, segment), T_world_submap);
  bool in_range = correction.in_range();
  for (int32_t k = 0; in_range && k < map_.submaps.size(); ++k) {
    const Submap& other = map_.submaps.at(k);
    if (other.segment != segment || other.place.node < 0) continue;
    in_range = (correction * submap_pose(other)).in_range();
  }
  for (int32_t id = map_.keyframes.first(); in_range && id < map_.keyframes.size(); ++id) {
    const Keyframe& keyframe = map_.keyframes[id];
    if (keyframe.segment != segment || !keyframe.posed()) continue;
    in_range = (correction * map_.keyframe_pose(id)).in_range();
  }
  return in_range;
}

/// Move a segment as a whole so that the view that joins it lies where the submap sees it.
void Session::join_segment(const Submap& submap, int32_t segment, int32_t into) {
  const SubmapView& view = joining_view(submap, segment);
  const Sim3 correction = join_correction(view, map_.graph.pose(submap.place.node));
  move_retired(segment, correction);
  holds(map_.metric.release(segment, &map_.graph));
  distances_.rescale_world(segment, into, math::log(correction.s));
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    Submap& other = map_.submaps.at(k);
    if (other.segment != segment) continue;
    other.segment = into;
    if (!other.place.own_node) continue;
    holds(map_.graph.set_pose(other.place.node, correction * map_.graph.pose(other.place.node)));
  }
  for (int32_t id = map_.keyframes.first(); id < map_.keyframes.size(); ++id) {
    Keyframe& keyframe = map_.keyframes[id];
    if (keyframe.segment != segment) continue;
    keyframe.segment = into;
    if (keyframe.node < 0) continue;
    holds(map_.graph.set_pose(keyframe.node, correction * map_.graph.pose(keyframe.node)));
  }
  --counts_.segments;
  LogLine line;
  line << "segment " << segment << " joined to segment " << into << " at keyframe "
       << view.keyframe;
  line.send(map_.config.log, LogLevel::kInfo);
}

/// Retired keyframes go with their owner; where only one of the two belongs to the segment that
/// moves, the offset between them changes.
void Session::move_retired(int32_t segment, const Sim3& correction) {
  for (int32_t id = map_.keyframes.first(); id < skeleton_.live_from(); ++id) {
    Keyframe& keyframe = map_.keyframes[id];
    if (!keyframe.retired()) continue;
    const Submap& owner = map_.submaps[keyframe.owner];
    const bool moves = keyframe.segment == segment;
    const bool owner_moves = owner.segment == segment;
    if (moves == owner_moves) continue;
    const Sim3 T_world_kf = map_.keyframe_pose(id);
    const Sim3 T_world_owner = submap_pose(owner);
    keyframe.T_owner_kf = moves ? between(T_world_owner, correction * T_world_kf)
                                : between(correction * T_world_owner, T_world_kf);
  }
}

}  // namespace unisim
