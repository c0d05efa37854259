// SPDX-License-Identifier: MIT
// The edges of a submap: bridge and scale_anchor to its keyframes, tie and scale to earlier
// submaps.
#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"
#include "core/graph/bridge.hpp"
#include "core/graph/tie.hpp"
#include "core/session.hpp"

namespace unisim {

Sim3 Session::view_measurement(const SubmapView& view) const {
  if (config_.preset == Preset::kPaper) return view.T_submap_kf;
  return bridge_measurement(view.T_submap_kf, math::exp(view.log_rho));
}

Sim3 Session::shared_measurement(const SharedKeyframe& shared) const {
  const SubmapView& view = submaps_.view(submaps_[shared.m], shared.view_m);
  if (config_.preset == Preset::kPaper) return view.T_submap_kf;
  return tie_measurement(view.T_submap_kf, math::exp(shared.log_c));
}

void Session::add_view_edges(int32_t id) {
  if (broken_) return;
  const Submap& submap = submaps_[id];
  for (int32_t k = 0; k < submap.count; ++k) {
    SubmapView& view = submaps_.view(submap, k);
    if (view.used) attach_view(submap, &view);
  }
}

/// A retired keyframe is held through its owner: T_i = S_owner X_i.
void Session::attach_view(const Submap& submap, SubmapView* view) {
  const Keyframe& keyframe = keyframes_[view->keyframe];
  const EdgeOrigin origin = submap.is_loop ? EdgeOrigin::kLoop : EdgeOrigin::kWindow;
  const bool rigid = keyframe.retired();
  const int32_t node = rigid ? submaps_[keyframe.owner].node : keyframe.node;
  const Sim3 T_node_kf =
      rigid ? submaps_[keyframe.owner].T_node_submap * keyframe.T_owner_kf : Sim3();
  if (config_.factor(FactorKind::kBridge).enabled) {
    const EdgeWeight weight = edge_weight(FactorKind::kBridge, submap.multiplier, origin);
    const Sim3 Z_m_i = view_measurement(*view);
    holds(rigid
              ? graph_.add_rigid_bridge(submap.node, node, Z_m_i, T_node_kf, weight, &view->bridge)
              : graph_.add_bridge(submap.node, node, Z_m_i, weight, &view->bridge));
  }
  if (config_.factor(FactorKind::kScaleAnchor).enabled) {
    const EdgeWeight weight = edge_weight(FactorKind::kScaleAnchor, submap.multiplier, origin);
    const double log_ratio = rigid ? view->log_rho - math::log(T_node_kf.s) : view->log_rho;
    holds(graph_.add_scale_anchor(submap.node, node, log_ratio, weight, &view->anchor));
  }
  if (submap.health.suspended) suspend_edges(submap, true);
}

void Session::add_shared_edges(int32_t id) {
  if (broken_) return;
  const Submap& submap = submaps_[id];
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = submaps_.view(submap, k);
    if (view.shared_submap < 0 || !take_window_pair(view.shared_submap, id)) continue;
    SharedKeyframe shared;
    shared.m = view.shared_submap;
    shared.n = id;
    shared.view_m = view.shared_view;
    shared.view_n = k;
    shared.log_c = view.log_c;
    if (config_.factor(FactorKind::kTie).enabled) {
      const double multiplier = std::min(submaps_[shared.m].multiplier, submap.multiplier);
      holds(graph_.add_tie(
          submaps_[shared.m].node, submap.node, shared_measurement(shared), view.T_submap_kf,
          edge_weight(FactorKind::kTie, multiplier, EdgeOrigin::kWindow), &shared.tie));
    }
    if (!submaps_.add_shared(shared)) holds(Status::kInternal);
  }
  if (!config_.factor(FactorKind::kScale).enabled) return;
  for (int32_t i = 0; i < submaps_.shared().size(); ++i) {
    const SharedKeyframe& shared = submaps_.shared()[i];
    if (shared.n == id && shared.scale < 0) add_scale_edge(shared.m, id);
  }
}

/// The solver's memory is declared for a number of submap pairs; windows cut by
/// unisim_close_window() at every turn could ask for more, and then go without a tie.
bool Session::take_window_pair(int32_t m, int32_t n) {
  for (const SharedKeyframe& shared : submaps_.shared()) {
    if (shared.m == m && shared.n == n) return true;
  }
  if (window_pairs_ == window_pair_capacity_) return false;
  ++window_pairs_;
  return true;
}

void Session::add_scale_edge(int32_t m, int32_t n) {
  const double multiplier = std::min(submaps_[m].multiplier, submaps_[n].multiplier);
  int32_t edge = -1;
  if (!holds(graph_.add_scale(submaps_[m].node, submaps_[n].node, median_log_c(m, n),
                              edge_weight(FactorKind::kScale, multiplier, EdgeOrigin::kWindow),
                              &edge))) {
    return;
  }
  for (SharedKeyframe& shared : submaps_.shared()) {
    if (shared.m == m && shared.n == n) shared.scale = edge;
  }
}

double Session::median_log_c(int32_t m, int32_t n) {
  double values[kMaxViews];
  int32_t count = 0;
  for (const SharedKeyframe& shared : submaps_.shared()) {
    if (shared.m == m && shared.n == n) values[count++] = shared.log_c;
  }
  return median({values, count});
}

/// Keep the depth of views that another window will share.
void Session::keep_shared_depth(const SubmapInput& input, int32_t id, const Window& window) {
  const Submap& submap = submaps_[id];
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = submaps_.view(submap, k);
    const bool in_next_window = view.keyframe > window.last() - config_.window_overlap;
    const bool in_open_window = windows_.find(view.keyframe, view.keyframe) >= 0;
    if (!view.used || !(in_next_window || in_open_window)) continue;
    depth_.sample(input.depth[k], &sampled_);
    depth_.keep_submap(sampled_, {view.keyframe, id, k});
  }
}

void Session::count_cover(int32_t id) {
  const Submap& submap = submaps_[id];
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = submaps_.view(submap, k);
    if (!view.used) continue;
    Keyframe& keyframe = keyframes_[view.keyframe];
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
