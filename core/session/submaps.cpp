// SPDX-License-Identifier: MIT
// Multi-view predictions: checks, depth ratios, quality, place in the world.
#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"
#include "core/graph/bridge.hpp"
#include "core/session.hpp"

namespace unisim {

Status Session::check_views(const SubmapInput& input, bool is_loop, int32_t* window) const {
  const int32_t count = input.keyframes.size();
  for (int32_t k = 0; k < count; ++k) {
    if (is_loop && keyframes_.gone(input.keyframes[k])) return Status::kRetired;
    if (!keyframes_.has(input.keyframes[k])) return Status::kInvalidArgument;
    if (k > 0 && input.keyframes[k] <= input.keyframes[k - 1]) return Status::kInvalidArgument;
  }
  const int32_t first = input.keyframes[0];
  const int32_t last = input.keyframes[count - 1];
  if (is_loop) {
    if (last > settled_) return Status::kNotReady;
  } else {
    *window = windows_.find(first, last);
    if (*window < 0) return Status::kInvalidArgument;
    if (windows_.at(*window).last() > settled_for_windows()) return Status::kNotReady;
  }
  const bool room = count <= config_.window_size && has_ids() &&
                    (slides() || submaps_.has_room(is_loop)) && (!is_loop || config_.max_loops > 0);
  return room ? Status::kOk : Status::kCapacity;
}

Status Session::add_submap(const SubmapInput& input, bool is_loop, int32_t* id) {
  int32_t window = -1;
  const Status status = check_views(input, is_loop, &window);
  if (!is_ok(status)) return status;
  const Window answered = is_loop ? Window{} : windows_.at(window);
  if (!is_loop) windows_.remove(window);

  if (slides()) make_submap_room(is_loop);
  const int32_t made = submaps_.append(is_loop, input.keyframes.size());
  Submap& submap = submaps_[made];
  submap.window_first = answered.first;
  submap.window_last = answered.last();
  submap.center_sigma = input.center_sigma;
  measure_views(input, is_loop, &submap);
  if (!choose_origin(&submap) || !judge_submap(&submap)) {
    submaps_.remove_last();
    *id = -1;
    return Status::kOk;
  }
  place_submap(&submap);
  adopt_views(input, submap);
  add_view_edges(made);
  add_shared_edges(made);
  if (!is_loop) keep_shared_depth(input, made, answered);
  count_cover(made);
  if (is_loop && !live_loops_.push_back(made)) holds(Status::kInternal);
  (is_loop ? skeleton_is_due_ : window_came_) = true;
  if (!is_loop && slides()) retire_surplus(made);
  make_node_room();
  ++(is_loop ? counts_.loops : counts_.windows);
  if (broken_) return Status::kInternal;
  *id = made;
  return Status::kOk;
}

void Session::measure_views(const SubmapInput& input, bool is_loop, Submap* submap) {
  double scatters[kMaxViews];
  int32_t measured = 0;
  for (int32_t k = 0; k < submap->count; ++k) {
    SubmapView& view = submaps_.view(*submap, k);
    submaps_.set_keyframe(*submap, k, input.keyframes[k]);
    view.segment = keyframes_[view.keyframe].posed() ? keyframes_[view.keyframe].segment : -1;
    view.T_submap_kf = input.T_submap_kf[k];
    measure_view(input.depth[k], !is_loop, !is_loop, &view);
    if (view.measured) scatters[measured++] = view.scatter;
  }
  submap->scatter = measured > 0 ? median({scatters, measured}) : 0.0;
}

void Session::measure_view(const DepthMap& depth, bool may_adopt, bool may_share,
                           SubmapView* view) {
  depth_.sample(depth, &sampled_);
  if (!sampled_.usable()) return;
  LogMedianRatio ratio = {};
  if (view->segment < 0) {
    // No pair stands behind this keyframe: the submap itself gives it its pose and unit.
    view->used = may_adopt;
  } else if (depth_.over_two_view(sampled_, view->keyframe, &ratio)) {
    view->log_rho = ratio.log_ratio;
    view->scatter = ratio.scatter;
    view->measured = true;
    view->used = true;
  }
  if (!may_share || !view->used) return;
  const DepthStore::Source source = depth_.submap_source(view->keyframe);
  const bool kept =
      source.keyframe >= 0 && submaps_.has(source.submap) && !submaps_[source.submap].retired;
  if (!kept || !depth_.over_submap(sampled_, view->keyframe, &ratio)) return;
  view->log_c = -ratio.log_ratio;
  view->shared_submap = source.submap;
  view->shared_view = source.view;
}

/// The measured view nearest to the centre, out of the oldest segment; views are re-anchored to it.
bool Session::choose_origin(Submap* submap) {
  const int32_t centre = submap->count / 2;
  int32_t best = -1;
  int32_t used = 0;
  for (int32_t k = 0; k < submap->count; ++k) {
    const SubmapView& view = submaps_.view(*submap, k);
    used += view.used ? 1 : 0;
    if (!view.measured) continue;
    const int32_t oldest = best < 0 ? view.segment : submaps_.view(*submap, best).segment;
    const bool nearer = best < 0 || std::abs(k - centre) < std::abs(best - centre);
    if (view.segment < oldest || (view.segment == oldest && nearer)) best = k;
  }
  constexpr int32_t kFewestViews = 2;
  if (best < 0 || used < kFewestViews) {
    refuse_submap(*submap, RefusalReason::kViews);
    return false;
  }
  submap->origin = best;
  submap->origin_keyframe = submaps_.view(*submap, best).keyframe;
  submap->segment = submaps_.view(*submap, best).segment;
  const Sim3 T_origin = submaps_.view(*submap, best).T_submap_kf;
  for (int32_t k = 0; k < submap->count; ++k) {
    Sim3& T_submap_kf = submaps_.view(*submap, k).T_submap_kf;
    T_submap_kf = between(T_origin, T_submap_kf);
  }
  return true;
}

bool Session::judge_submap(Submap* submap) {
  const bool known = submap->center_sigma > 0.0;
  const double sigma_gate = submap->is_loop ? config_.sigma_gate_loop : config_.sigma_gate;
  const double value = known ? submap->center_sigma : submap->scatter;
  const double gate = known ? sigma_gate : config_.scatter_gate;
  submap->multiplier = quality_multiplier(submap->center_sigma);
  if (value > gate) {
    refuse_submap(*submap, known ? RefusalReason::kSigma : RefusalReason::kScatter, value, gate);
    return false;
  }
  if (is_in_range(*submap)) return true;
  refuse_submap(*submap, RefusalReason::kRange);
  return false;
}

/// Depth that leaps by many orders of magnitude, again and again, leaves the range of numbers.
bool Session::is_in_range(const Submap& submap) const {
  const Sim3 T_world_submap = first_pose(submap);
  bool in_range = T_world_submap.in_range();
  for (int32_t k = 0; in_range && k < submap.count; ++k) {
    const SubmapView& view = submaps_.view(submap, k);
    if (!view.used) continue;
    const Sim3 Z_m_i = bridge_measurement(view.T_submap_kf, math::exp(view.log_rho));
    in_range = Z_m_i.in_range() && (T_world_submap * Z_m_i).in_range() &&
               Sim3::scaling(math::exp(view.log_c)).in_range();
    if (in_range && view.measured) in_range = joins_in_range(submap, T_world_submap, view.segment);
  }
  return in_range;
}

void Session::refuse_submap(const Submap& submap, RefusalReason reason, double value,
                            double limit) {
  const PredictionKind kind = submap.is_loop ? PredictionKind::kLoop : PredictionKind::kWindow;
  refusals_.add(kind, {reason, submaps_.keyframe(submap, 0),
                       submaps_.keyframe(submap, submap.count - 1), value, limit});
}

void Session::refuse_window(const Window& window, RefusalReason reason) {
  refusals_.add(PredictionKind::kWindow, {reason, window.first, window.last(), 0.0, 0.0});
}

/// S_m = [(s_o / rho_mo) R_o, t_o] of its origin.
Sim3 Session::first_pose(const Submap& submap) const {
  const SubmapView& origin = submaps_.view(submap, submap.origin);
  return keyframe_pose(origin.keyframe) * Sim3::scaling(math::exp(-origin.log_rho));
}

/// Segments that its other views belong to follow.
void Session::place_submap(Submap* submap) {
  const SubmapView& origin = submaps_.view(*submap, submap->origin);
  if (!holds(graph_.add_node(NodeKind::kSubmap, first_pose(*submap), &submap->node))) return;
  for (int32_t k = 0; k < submap->count; ++k) {
    const SubmapView& view = submaps_.view(*submap, k);
    if (view.measured && keyframes_[view.keyframe].segment != origin.segment) {
      skeleton_is_due_ = true;
      join_segment(*submap, keyframes_[view.keyframe].segment, origin.segment);
      if (submap->is_loop) tracking_.segments_joined_by_loop();
    }
  }
}

/// View by which a submap joins a segment to its own: the one nearest to its centre.
const SubmapView& Session::joining_view(const Submap& submap, int32_t segment) const {
  const int32_t centre = submap.count / 2;
  int32_t best = -1;
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = submaps_.view(submap, k);
    if (!view.measured || keyframes_[view.keyframe].segment != segment) continue;
    if (best < 0 || std::abs(k - centre) < std::abs(best - centre)) best = k;
  }
  return submaps_.view(submap, best);
}

/// How the view's segment has to move for the view to lie where the submap sees it.
Sim3 Session::join_correction(const SubmapView& view, const Sim3& T_world_submap) const {
  const Sim3 T_world_kf =
      T_world_submap * bridge_measurement(view.T_submap_kf, math::exp(view.log_rho));
  return T_world_kf * keyframe_pose(view.keyframe).inverse();
}

/// Would all that follows a submap into its segment stay within the range of numbers?
bool Session::joins_in_range(const Submap& submap, const Sim3& T_world_submap,
                             int32_t segment) const {
  if (segment == submap.segment) return true;
  const Sim3 correction = join_correction(joining_view(submap, segment), T_world_submap);
  bool in_range = correction.in_range();
  for (int32_t k = 0; in_range && k < submaps_.size(); ++k) {
    const Submap& other = submaps_.at(k);
    if (other.segment != segment || other.node < 0) continue;
    in_range = (correction * submap_pose(other)).in_range();
  }
  for (int32_t id = keyframes_.first(); in_range && id < keyframes_.size(); ++id) {
    const Keyframe& keyframe = keyframes_[id];
    if (keyframe.segment != segment || !keyframe.posed()) continue;
    in_range = (correction * keyframe_pose(id)).in_range();
  }
  return in_range;
}

/// Move a segment as a whole so that the view that joins it lies where the submap sees it.
void Session::join_segment(const Submap& submap, int32_t segment, int32_t into) {
  const SubmapView& view = joining_view(submap, segment);
  const Sim3 correction = join_correction(view, graph_.pose(submap.node));
  move_retired(segment, correction);
  for (int32_t k = 0; k < submaps_.size(); ++k) {
    Submap& other = submaps_.at(k);
    if (other.segment != segment) continue;
    other.segment = into;
    if (!other.own_node) continue;
    holds(graph_.set_pose(other.node, correction * graph_.pose(other.node)));
  }
  for (int32_t id = keyframes_.first(); id < keyframes_.size(); ++id) {
    Keyframe& keyframe = keyframes_[id];
    if (keyframe.segment != segment) continue;
    keyframe.segment = into;
    if (keyframe.node < 0) continue;
    holds(graph_.set_pose(keyframe.node, correction * graph_.pose(keyframe.node)));
  }
  --counts_.segments;
  LogLine line;
  line << "segment " << segment << " joined to segment " << into << " at keyframe "
       << view.keyframe;
  line.send(config_.log, LogLevel::kInfo);
}

/// Retired keyframes go with their owner; where only one of the two belongs to the segment that
/// moves, the offset between them changes.
void Session::move_retired(int32_t segment, const Sim3& correction) {
  for (int32_t id = keyframes_.first(); id < live_from_; ++id) {
    Keyframe& keyframe = keyframes_[id];
    if (!keyframe.retired()) continue;
    const Submap& owner = submaps_[keyframe.owner];
    const bool moves = keyframe.segment == segment;
    const bool owner_moves = owner.segment == segment;
    if (moves == owner_moves) continue;
    const Sim3 T_world_kf = keyframe_pose(id);
    const Sim3 T_world_owner = submap_pose(owner);
    keyframe.T_owner_kf = moves ? between(T_world_owner, correction * T_world_kf)
                                : between(correction * T_world_owner, T_world_kf);
  }
}

/// Keyframes without a pose of their own get the submap's, in the submap's unit.
void Session::adopt_views(const SubmapInput& input, const Submap& submap) {
  if (broken_) return;
  const int32_t segment = submaps_.view(submap, submap.origin).segment;
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = submaps_.view(submap, k);
    if (!view.used || view.measured) continue;
    give_node(view.keyframe, graph_.pose(submap.node) * view.T_submap_kf, segment);
    depth_.sample(input.depth[k], &sampled_);
    depth_.keep_two_view(sampled_, view.keyframe);
  }
}

}  // namespace unisim
