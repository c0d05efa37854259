// SPDX-License-Identifier: MIT
// Turns what lies between two nodes into one chain edge.
#include "core/skeleton/chain_maker.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/map/view_edges.hpp"

namespace unisim {
namespace {

/// The same factor between two other nodes; its kind matters no more.
Status copy_edge(const Graph& from, const Edge& edge, int32_t a, int32_t b, Graph* to) {
  const EdgeWeight weight = edge.given_weight();
  int32_t id = -1;
  if (!is_pose_factor(edge.kind)) return to->add_scale(a, b, edge.log_ratio, weight, &id);
  const Sim3& P = from.measurement(edge.P);
  if (edge.Q < 0) return to->add_two_view(a, b, P, weight, &id);
  return to->add_tie(a, b, P, from.measurement(edge.Q), weight, &id);
}

}  // namespace

bool ChainMaker::between_windows(const Submap& m, const Submap& n, ChainLink* link) {
  if (!load_between(m, n)) {
    guess(m, n, link);
    return m.segment == n.segment;
  }
  return condenser_.condense(local_node_[m.place.node], local_node_[n.place.node], link);
}

/// false: more keyframes between the origins than the condenser takes.
bool ChainMaker::load_between(const Submap& m, const Submap& n) {
  condenser_.clear();
  Graph& local = condenser_.graph();
  const Graph& graph = map_.graph;
  local_node_.fill(-1);
  const Sim3 T_world_m = graph.pose(m.place.node);
  const auto add = [&](NodeKind kind, int32_t node) {
    return is_ok(local.add_node(kind, between(T_world_m, graph.pose(node)), &local_node_[node]));
  };
  bool fits = add(NodeKind::kSubmap, m.place.node) && add(NodeKind::kSubmap, n.place.node);
  const int32_t first = map_.submaps.origin_keyframe(m);
  const int32_t last = map_.submaps.origin_keyframe(n);
  for (int32_t id = std::min(first, last); fits && id <= std::max(first, last); ++id) {
    const int32_t node = map_.keyframes.has(id) ? map_.keyframes[id].node : -1;
    if (node >= 0) fits = add(NodeKind::kKeyframe, node);
  }
  for (int32_t id = 0; fits && id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (!edge.active() || edge.origin == EdgeOrigin::kLoop || edge.kind == FactorKind::kChain) {
      continue;
    }
    const int32_t a = local_node_[edge.a];
    const int32_t b = local_node_[edge.b];
    if (a >= 0 && b >= 0) fits = is_ok(copy_edge(graph, edge, a, b, &local));
  }
  return fits;
}

/// A stretch too long to condense, windows refused in a row: where it is now, as sure as that many
/// two-view edges.
void ChainMaker::guess(const Submap& m, const Submap& n, ChainLink* link) const {
  const int32_t first = map_.submaps.origin_keyframe(m);
  const int32_t last = map_.submaps.origin_keyframe(n);
  const double information = map_.config.factor(FactorKind::kTwoView).information;
  link->Z_a_b = between(map_.graph.pose(m.place.node), map_.graph.pose(n.place.node));
  link->Lambda = Mat7::Identity() * (information / std::max<int32_t>(1, std::abs(last - first)));
}

bool ChainMaker::takes_part(const Submap& loop, int32_t k) const {
  const SubmapView& view = map_.submaps.view(loop, k);
  return view.used && map_.keyframes.has(view.keyframe);
}

/// Of the views begin .. end - 1 that take part the last one before the middle, else the last.
int32_t ChainMaker::middle_view(const Submap& loop, int32_t begin, int32_t end) const {
  int32_t best = -1;
  for (int32_t k = begin; k < end; ++k) {
    if (takes_part(loop, k) && (best < 0 || k <= (begin + end) / 2)) best = k;
  }
  return best;
}

/// The small graph has three nodes: a, b and the loop. It starts from what the loop says, not from
/// the poses of the map: where the map has drifted far, they could lead to another minimum.
bool ChainMaker::of_loop(const Submap& loop, int32_t a, int32_t b, int32_t split, ChainLink* link) {
  condenser_.clear();
  Graph& local = condenser_.graph();
  const auto T_node_kf = [&](int32_t k) {
    return between(map_.graph.pose(k < split ? a : b),
                   map_.keyframe_pose(map_.submaps.view(loop, k).keyframe));
  };
  const auto Z_loop_kf = [&](int32_t k) {
    return view_measurement(map_.config, map_.submaps.view(loop, k));
  };
  const int32_t at_a = middle_view(loop, 0, split);
  const int32_t at_b = middle_view(loop, split, loop.count);
  const Sim3 T_a_loop = T_node_kf(at_a) * Z_loop_kf(at_a).inverse();
  const Sim3 T_a_b = T_a_loop * Z_loop_kf(at_b) * T_node_kf(at_b).inverse();
  int32_t local_a = -1;
  int32_t local_b = -1;
  int32_t local_loop = -1;
  bool fits = is_ok(local.add_node(NodeKind::kSubmap, Sim3(), &local_a)) &&
              is_ok(local.add_node(NodeKind::kSubmap, T_a_b, &local_b)) &&
              is_ok(local.add_node(NodeKind::kSubmap, T_a_loop, &local_loop));
  for (int32_t k = 0; fits && k < loop.count; ++k) {
    if (!takes_part(loop, k)) continue;
    fits = add_rigid_view(loop, k, T_node_kf(k), local_loop, k < split ? local_a : local_b);
  }
  return fits && condenser_.condense(local_a, local_b, link);
}

/// Edges of a view between two nodes of the small graph.
bool ChainMaker::add_rigid_view(const Submap& loop, int32_t k, const Sim3& T_node_kf, int32_t from,
                                int32_t to) {
  Graph& local = condenser_.graph();
  const SessionConfig& config = map_.config;
  const SubmapView& view = map_.submaps.view(loop, k);
  const double multiplier = loop.quality.multiplier;
  int32_t edge = -1;
  if (config.factor(FactorKind::kBridge).enabled) {
    const Status status = local.add_rigid_bridge(
        from, to, view_measurement(config, view), T_node_kf,
        config.edge_weight(FactorKind::kBridge, multiplier, EdgeOrigin::kWindow), &edge);
    if (!is_ok(status)) return false;
  }
  if (!config.factor(FactorKind::kScaleAnchor).enabled) return true;
  return is_ok(local.add_scale_anchor(
      from, to, view.log_rho - math::log(T_node_kf.s),
      config.edge_weight(FactorKind::kScaleAnchor, multiplier, EdgeOrigin::kWindow), &edge));
}

}  // namespace unisim
