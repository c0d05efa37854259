// SPDX-License-Identifier: MIT
// Multi-view predictions: checks, depth ratios, quality, place in the world.
#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"
#include "core/graph/bridge.hpp"
#include "core/map/view_edges.hpp"
#include "core/session.hpp"

namespace unisim {

Status Session::check_views(const SubmapInput& input, bool is_loop, int32_t* window) const {
  const int32_t count = input.keyframes.size();
  for (int32_t k = 0; k < count; ++k) {
    if (is_loop && map_.keyframes.gone(input.keyframes[k])) return Status::kRetired;
    if (!map_.keyframes.has(input.keyframes[k])) return Status::kInvalidArgument;
    if (k > 0 && input.keyframes[k] <= input.keyframes[k - 1]) return Status::kInvalidArgument;
  }
  const int32_t first = input.keyframes[0];
  const int32_t last = input.keyframes[count - 1];
  if (is_loop) {
    if (last > map_.keyframes.settled()) return Status::kNotReady;
  } else {
    const Status status = requests_.find_window(first, last, window);
    if (!is_ok(status)) return status;
  }
  const bool room = count <= map_.config.window_size && has_ids() &&
                    (map_.config.slides() || map_.submaps.has_room(is_loop)) &&
                    (!is_loop || map_.config.max_loops > 0);
  return room ? Status::kOk : Status::kCapacity;
}

Status Session::add_submap(const SubmapInput& input, bool is_loop, int32_t* id) {
  int32_t open = -1;
  const Status status = check_views(input, is_loop, &open);
  if (!is_ok(status)) return status;
  const Window window = is_loop ? Window{} : requests_.take_window(open);

  if (map_.config.slides()) skeleton_.make_room(is_loop);
  const int32_t made = map_.submaps.append(is_loop, input.keyframes.size());
  Submap& submap = map_.submaps[made];
  submap.window = {window.first, window.last()};
  submap.quality.center_sigma = input.center_sigma;
  measure_views(input, is_loop, &submap);
  if (!choose_origin(&submap) || !judge_submap(&submap)) {
    map_.submaps.remove_last();
    refuse_late_windows();
    *id = -1;
    return Status::kOk;
  }
  place_submap(&submap);
  connect(input, made, window);
  if (is_loop) {
    settle_scale({input.keyframes[0], input.keyframes[input.keyframes.size() - 1]});
    skeleton_.add_loop(made);
    watch_.note_news();
  } else {
    window_came_ = true;
    if (map_.config.slides()) skeleton_.add_window(made);
  }
  make_node_room();
  ++(is_loop ? counts_.loops : counts_.windows);
  if (broken()) return Status::kInternal;
  *id = made;
  return Status::kOk;
}

/// Edges to what the submap sees, and what later submaps need of it.
void Session::connect(const SubmapInput& input, int32_t id, const Window& window) {
  const Submap& submap = map_.submaps[id];
  adopt_views(input, submap);
  for (int32_t k = 0; k < submap.count && !broken(); ++k) {
    SubmapView& view = map_.submaps.view(submap, k);
    if (view.used) add_view_edges(map_, submap, &view);
  }
  ties_.add(id);
  if (!submap.is_loop) keep_shared_depth(input, id, window);
  count_cover(id);
}

void Session::measure_views(const SubmapInput& input, bool is_loop, Submap* submap) {
  double scatters[kMaxViews];
  int32_t measured = 0;
  for (int32_t k = 0; k < submap->count; ++k) {
    SubmapView& view = map_.submaps.view(*submap, k);
    map_.submaps.set_keyframe(*submap, k, input.keyframes[k]);
    view.segment =
        map_.keyframes[view.keyframe].posed() ? map_.keyframes[view.keyframe].segment : -1;
    view.T_submap_kf = input.T_submap_kf[k];
    measure_view(input.depth[k], !is_loop, &view);
    if (view.measured) scatters[measured++] = view.scatter;
  }
  submap->quality.scatter = measured > 0 ? median({scatters, measured}) : 0.0;
}

void Session::measure_view(const DepthMap& depth, bool is_window, SubmapView* view) {
  depth_.sample(depth, &sampled_);
  if (!sampled_.usable()) return;
  LogMedianRatio ratio = {};
  if (view->segment < 0) {
    // No pair stands behind this keyframe: a window gives it its pose and unit itself.
    view->used = is_window;
  } else if (depth_.over_two_view(sampled_, view->keyframe, &ratio)) {
    view->log_rho = ratio.log_ratio;
    view->scatter = ratio.scatter;
    view->measured = true;
    view->used = true;
  }
  if (is_window && view->used) find_shared(view);
}

/// The newest submap that saw the keyframe too, if it still has its views.
void Session::find_shared(SubmapView* view) {
  const DepthStore::Source source = depth_.submap_source(view->keyframe);
  const bool kept = source.keyframe >= 0 && map_.submaps.has(source.submap) &&
                    !map_.submaps[source.submap].place.retired;
  LogMedianRatio ratio = {};
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
    const SubmapView& view = map_.submaps.view(*submap, k);
    used += view.used ? 1 : 0;
    if (!view.measured) continue;
    const int32_t oldest = best < 0 ? view.segment : map_.submaps.view(*submap, best).segment;
    const bool nearer = best < 0 || std::abs(k - centre) < std::abs(best - centre);
    if (view.segment < oldest || (view.segment == oldest && nearer)) best = k;
  }
  constexpr int32_t kFewestViews = 2;
  if (best < 0 || used < kFewestViews) {
    refuse_submap(*submap, RefusalReason::kViews);
    return false;
  }
  submap->origin = best;
  submap->segment = map_.submaps.view(*submap, best).segment;
  const Sim3 T_origin = map_.submaps.view(*submap, best).T_submap_kf;
  for (int32_t k = 0; k < submap->count; ++k) {
    Sim3& T_submap_kf = map_.submaps.view(*submap, k).T_submap_kf;
    T_submap_kf = between(T_origin, T_submap_kf);
  }
  return true;
}

bool Session::judge_submap(Submap* submap) {
  const bool known = submap->quality.center_sigma > 0.0;
  const double sigma_gate = submap->is_loop ? map_.config.sigma_gate_loop : map_.config.sigma_gate;
  const double value = known ? submap->quality.center_sigma : submap->quality.scatter;
  const double gate = known ? sigma_gate : map_.config.scatter_gate;
  submap->quality.multiplier = window_multiplier(*submap);
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
    const SubmapView& view = map_.submaps.view(submap, k);
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
  refusals_.add(kind, {reason, map_.submaps.keyframe(submap, 0),
                       map_.submaps.keyframe(submap, submap.count - 1), value, limit});
}

void Session::refuse_window(const Window& window, RefusalReason reason) {
  refusals_.add(PredictionKind::kWindow, {reason, window.first, window.last(), 0.0, 0.0});
}

/// Keyframes without a pose of their own get the submap's, in the submap's unit.
void Session::adopt_views(const SubmapInput& input, const Submap& submap) {
  if (broken()) return;
  const int32_t segment = map_.submaps.view(submap, submap.origin).segment;
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = map_.submaps.view(submap, k);
    if (!view.used || view.measured) continue;
    give_node(view.keyframe, map_.graph.pose(submap.place.node) * view.T_submap_kf, segment);
    depth_.sample(input.depth[k], &sampled_);
    depth_.keep_two_view(sampled_, view.keyframe);
  }
}

/// Keep the depth of views that another window will share.
void Session::keep_shared_depth(const SubmapInput& input, int32_t id, const Window& window) {
  const Submap& submap = map_.submaps[id];
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = map_.submaps.view(submap, k);
    const bool in_next_window = view.keyframe > window.last() - map_.config.window_overlap;
    const bool in_open_window = requests_.has_window_over(view.keyframe);
    if (!view.used || !(in_next_window || in_open_window)) continue;
    depth_.sample(input.depth[k], &sampled_);
    depth_.keep_submap(sampled_, {view.keyframe, id, k});
  }
}

void Session::count_cover(int32_t id) {
  const Submap& submap = map_.submaps[id];
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = map_.submaps.view(submap, k);
    if (!view.used) continue;
    Keyframe& keyframe = map_.keyframes[view.keyframe];
    const int32_t distance = std::abs(k - submap.count / 2);
    const bool nearer = keyframe.best_submap < 0 || distance < keyframe.best_distance;
    if (nearer && (!submap.is_loop || keyframe.window_count == 0)) {
      keyframe.best_submap = id;
      keyframe.best_distance = distance;
    }
    ++(submap.is_loop ? keyframe.loop_count : keyframe.window_count);
  }
}

}  // namespace unisim
