// SPDX-License-Identifier: MIT
// A submap measured anew: its edges get the better numbers.
#include <algorithm>

#include "core/base/math.hpp"
#include "core/graph/bridge.hpp"
#include "core/session.hpp"

namespace unisim {

Status Session::update_submap(const SubmapUpdate& update) {
  if (submaps_.gone(update.submap)) return Status::kRetired;
  if (!submaps_.has(update.submap)) return Status::kInvalidArgument;
  Submap& submap = submaps_[update.submap];
  if (submap.node < 0 || update.T_submap_kf.size() != submap.count) {
    return Status::kInvalidArgument;
  }
  if (submap.retired || submap.removed) return Status::kOk;
  if (!is_in_range(update, submap)) return Status::kInvalidArgument;
  const double gate = submap.is_loop ? config_.sigma_gate_loop : config_.sigma_gate;
  if (update.center_sigma > gate) {
    refuse_submap(submap, RefusalReason::kSigma, update.center_sigma, gate);
    return Status::kOk;
  }
  if (update.center_sigma > 0.0) {
    submap.center_sigma = update.center_sigma;
    submap.multiplier = quality_multiplier(update.center_sigma);
  }
  skeleton_is_due_ = skeleton_is_due_ || submap.is_loop;
  update_views(update, &submap);
  update_shared(update);
  return broken_ ? Status::kInternal : Status::kOk;
}

/// Ratios that only grow, update after update, leave the range of numbers.
bool Session::is_in_range(const SubmapUpdate& update, const Submap& submap) const {
  const double unit = math::exp(-update.log_depth_ratio[submap.origin]);
  if (!(graph_.pose(submap.node) * Sim3::scaling(unit)).in_range()) return false;
  const Sim3 T_origin = update.T_submap_kf[submap.origin];
  for (int32_t k = 0; k < submap.count; ++k) {
    const double rho = math::exp(submaps_.view(submap, k).log_rho + update.log_depth_ratio[k]);
    const Sim3 T_submap_kf = between(T_origin, update.T_submap_kf[k]);
    if (!bridge_measurement(T_submap_kf, rho).in_range()) return false;
  }
  for (const SharedKeyframe& shared : submaps_.shared()) {
    double log_c = shared.log_c;
    if (shared.m == submap.id) log_c += update.log_depth_ratio[shared.view_m];
    if (shared.n == submap.id) log_c -= update.log_depth_ratio[shared.view_n];
    if (!Sim3::scaling(math::exp(log_c)).in_range()) return false;
  }
  return true;
}

void Session::update_views(const SubmapUpdate& update, Submap* submap) {
  const Sim3 T_origin = update.T_submap_kf[submap->origin];
  for (int32_t k = 0; k < submap->count; ++k) {
    SubmapView& view = submaps_.view(*submap, k);
    view.T_submap_kf = between(T_origin, update.T_submap_kf[k]);
    view.log_rho += update.log_depth_ratio[k];
    depth_.rescale_submap(update.submap, k, math::exp(update.log_depth_ratio[k]));
    if (view.bridge >= 0) {
      set_bridge_measurement(view);
      holds(graph_.set_multiplier(view.bridge, submap->multiplier));
    }
    if (view.anchor >= 0) {
      const double log_ratio = graph_.edge(view.anchor).log_ratio + update.log_depth_ratio[k];
      holds(graph_.set_log_ratio(view.anchor, log_ratio));
      holds(graph_.set_multiplier(view.anchor, submap->multiplier));
    }
  }
  // The unit may be another one: the submap's scale follows, so that its origin keyframe stays.
  const double unit = math::exp(-update.log_depth_ratio[submap->origin]);
  holds(graph_.set_pose(submap->node, graph_.pose(submap->node) * Sim3::scaling(unit)));
}

void Session::set_bridge_measurement(const SubmapView& view) {
  const Sim3 Z_m_i = view_measurement(view);
  const int32_t rigid = graph_.edge(view.bridge).Q;
  if (rigid < 0) {
    holds(graph_.set_measurement(view.bridge, Z_m_i));
  } else {
    const Sim3 T_owner_kf = graph_.measurement(rigid);
    holds(graph_.set_tie_measurement(view.bridge, Z_m_i, T_owner_kf));
  }
}

void Session::update_shared(const SubmapUpdate& update) {
  for (SharedKeyframe& shared : submaps_.shared()) {
    if (shared.m == update.submap) shared.log_c += update.log_depth_ratio[shared.view_m];
    if (shared.n == update.submap) shared.log_c -= update.log_depth_ratio[shared.view_n];
  }
  for (const SharedKeyframe& shared : submaps_.shared()) {
    if (shared.m != update.submap && shared.n != update.submap) continue;
    const Submap& m = submaps_[shared.m];
    const Submap& n = submaps_[shared.n];
    const double multiplier = std::min(m.multiplier, n.multiplier);
    if (shared.tie >= 0) {
      const Sim3& T_submap_n_kf = submaps_.view(n, shared.view_n).T_submap_kf;
      holds(graph_.set_tie_measurement(shared.tie, shared_measurement(shared), T_submap_n_kf));
      holds(graph_.set_multiplier(shared.tie, multiplier));
    }
    if (shared.scale >= 0) {
      holds(graph_.set_log_ratio(shared.scale, median_log_c(shared.m, shared.n)));
      holds(graph_.set_multiplier(shared.scale, multiplier));
    }
  }
}

}  // namespace unisim
