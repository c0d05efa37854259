// SPDX-License-Identifier: MIT
// A submap measured anew: its edges get the better numbers.
#include <algorithm>

#include "core/base/math.hpp"
#include "core/graph/bridge.hpp"
#include "core/map/view_edges.hpp"
#include "core/session.hpp"

namespace unisim {

Status Session::update_submap(const SubmapUpdate& update) {
  if (map_.submaps.gone(update.submap)) return Status::kRetired;
  if (!map_.submaps.has(update.submap)) return Status::kInvalidArgument;
  Submap& submap = map_.submaps[update.submap];
  if (submap.place.node < 0 || update.T_submap_kf.size() != submap.count) {
    return Status::kInvalidArgument;
  }
  if (submap.place.retired || submap.removed) return Status::kOk;
  if (!is_in_range(update, submap)) return Status::kInvalidArgument;
  const double gate = submap.is_loop ? map_.config.sigma_gate_loop : map_.config.sigma_gate;
  if (update.center_sigma > gate) {
    refuse_submap(submap, RefusalReason::kSigma, update.center_sigma, gate);
    return Status::kOk;
  }
  if (update.center_sigma > 0.0) {
    submap.quality.center_sigma = update.center_sigma;
    submap.quality.multiplier = window_multiplier(submap);
  }
  if (update.scale_settled && !submap.is_loop) settle_scale(submap.window);
  if (submap.is_loop) watch_.note_news();
  update_views(update, &submap);
  ties_.rescale(update.submap, update.log_depth_ratio);
  return broken() ? Status::kInternal : Status::kOk;
}

/// Ratios that only grow, update after update, leave the range of numbers.
bool Session::is_in_range(const SubmapUpdate& update, const Submap& submap) const {
  const double unit = math::exp(-update.log_depth_ratio[submap.origin]);
  if (!(map_.graph.pose(submap.place.node) * Sim3::scaling(unit)).in_range()) return false;
  const Sim3 T_origin = update.T_submap_kf[submap.origin];
  for (int32_t k = 0; k < submap.count; ++k) {
    const double rho = math::exp(map_.submaps.view(submap, k).log_rho + update.log_depth_ratio[k]);
    const Sim3 T_submap_kf = between(T_origin, update.T_submap_kf[k]);
    if (!bridge_measurement(T_submap_kf, rho).in_range()) return false;
  }
  for (const SharedKeyframe& shared : map_.submaps.shared()) {
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
    SubmapView& view = map_.submaps.view(*submap, k);
    view.T_submap_kf = between(T_origin, update.T_submap_kf[k]);
    view.log_rho += update.log_depth_ratio[k];
    depth_.rescale_submap(update.submap, k, math::exp(update.log_depth_ratio[k]));
    if (view.bridge >= 0) set_bridge_measurement(view);
    if (view.anchor >= 0) {
      const double log_ratio = map_.graph.edge(view.anchor).log_ratio + update.log_depth_ratio[k];
      holds(map_.graph.set_log_ratio(view.anchor, log_ratio));
    }
  }
  weigh_views(*submap);
  // The unit may be another one: the submap's scale follows, so that its origin keyframe stays.
  const double unit = math::exp(-update.log_depth_ratio[submap->origin]);
  map_.metric.rescale(submap->place.node, -update.log_depth_ratio[submap->origin]);
  holds(map_.graph.set_pose(submap->place.node,
                            map_.graph.pose(submap->place.node) * Sim3::scaling(unit)));
}

void Session::set_bridge_measurement(const SubmapView& view) {
  const Sim3 Z_m_i = view_measurement(map_.config, view);
  const int32_t rigid = map_.graph.edge(view.bridge).Q;
  if (rigid < 0) {
    holds(map_.graph.set_measurement(view.bridge, Z_m_i));
  } else {
    const Sim3 T_owner_kf = map_.graph.measurement(rigid);
    holds(map_.graph.set_tie_measurement(view.bridge, Z_m_i, T_owner_kf));
  }
}

}  // namespace unisim
