// SPDX-License-Identifier: MIT
// Takes the freedom of position, orientation and scale out of a graph.
#include "core/map/gauge.hpp"

namespace unisim {
namespace {

/// Skeleton nodes are the oldest part of a map, and the past is what stays where it is.
int32_t rank(NodeKind kind) {
  if (kind == NodeKind::kSkeleton) return 0;
  return kind == NodeKind::kKeyframe ? 1 : 2;
}

}  // namespace

int32_t Gauge::root_of(int32_t node) {
  while (parent_[node] != node) {
    parent_[node] = parent_[parent_[node]];
    node = parent_[node];
  }
  return node;
}

bool Gauge::comes_first(const Graph& graph, int32_t a, int32_t b) {
  const Node& node_a = graph.node(a);
  const Node& node_b = graph.node(b);
  const int32_t rank_a = rank(node_a.kind);
  const int32_t rank_b = rank(node_b.kind);
  return rank_a == rank_b ? node_a.serial < node_b.serial : rank_a < rank_b;
}

Status Gauge::apply(Graph* graph) {
  if (graph->activity_revision() == activity_revision_) return Status::kOk;
  for (int32_t node = 0; node < graph->node_end(); ++node) parent_[node] = node;
  for (int32_t id = 0; id < graph->edge_end(); ++id) {
    const Edge& edge = graph->edge(id);
    if (!edge.active() || !is_pose_factor(edge.kind)) continue;
    const int32_t a = root_of(edge.a);
    const int32_t b = root_of(edge.b);
    if (a == b) continue;
    const bool a_first = comes_first(*graph, a, b);
    parent_[a_first ? b : a] = a_first ? a : b;
  }
  for (int32_t node = 0; node < graph->node_end(); ++node) {
    if (!graph->has_node(node) || graph->node(node).kind == NodeKind::kMetre) continue;
    const bool hold = root_of(node) == node;
    if (graph->node(node).fixed == hold) continue;
    const Status status = graph->set_fixed(node, hold);
    if (!is_ok(status)) return status;
  }
  activity_revision_ = graph->activity_revision();
  return Status::kOk;
}

}  // namespace unisim
