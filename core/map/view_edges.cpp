// SPDX-License-Identifier: MIT
// Edges between a submap and the keyframes it sees: bridge and scale_anchor.
#include "core/map/view_edges.hpp"

#include "core/base/math.hpp"
#include "core/graph/bridge.hpp"

namespace unisim {

Sim3 view_measurement(const SessionConfig& config, const SubmapView& view) {
  if (config.preset == Preset::kPaper) return view.T_submap_kf;
  return bridge_measurement(view.T_submap_kf, math::exp(view.log_rho));
}

void add_view_edges(Map& map, const Submap& submap, SubmapView* view) {
  const Keyframe& keyframe = map.keyframes[view->keyframe];
  const EdgeOrigin origin = submap.is_loop ? EdgeOrigin::kLoop : EdgeOrigin::kWindow;
  const double multiplier = submap.quality.multiplier;
  const int32_t from = submap.place.node;
  const bool rigid = keyframe.retired();
  const SubmapPlace owner = rigid ? map.submaps[keyframe.owner].place : SubmapPlace();
  const int32_t to = rigid ? owner.node : keyframe.node;
  const Sim3 T_node_kf = rigid ? owner.T_node_submap * keyframe.T_owner_kf : Sim3();
  if (map.config.factor(FactorKind::kBridge).enabled) {
    const EdgeWeight weight = map.config.edge_weight(FactorKind::kBridge, multiplier, origin);
    const Sim3 Z_m_i = view_measurement(map.config, *view);
    map.holds(rigid ? map.graph.add_rigid_bridge(from, to, Z_m_i, T_node_kf, weight, &view->bridge)
                    : map.graph.add_bridge(from, to, Z_m_i, weight, &view->bridge));
  }
  if (map.config.factor(FactorKind::kScaleAnchor).enabled) {
    const EdgeWeight weight = map.config.edge_weight(FactorKind::kScaleAnchor, multiplier, origin);
    const double log_ratio = rigid ? view->log_rho - math::log(T_node_kf.s) : view->log_rho;
    map.holds(map.graph.add_scale_anchor(from, to, log_ratio, weight, &view->anchor));
  }
}

void drop_view_edges(Map& map, SubmapView* view) {
  for (int32_t* edge : {&view->bridge, &view->anchor}) {
    if (*edge >= 0) map.holds(map.graph.remove_edge(*edge));
    *edge = -1;
  }
}

}  // namespace unisim
