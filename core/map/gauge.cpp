// SPDX-License-Identifier: MIT
// Takes the freedom of position, orientation and scale out of a graph.
#include "core/map/gauge.hpp"

namespace unisim {

int32_t Gauge::root_of(int32_t node) {
  while (parent_[node] != node) {
    parent_[node] = parent_[parent_[node]];
    node = parent_[node];
  }
  return node;
}

bool Gauge::comes_first(const Graph& graph, int32_t a, int32_t b) {
  const NodeKind kind_a = graph.node(a).kind;
  const NodeKind kind_b = graph.node(b).kind;
  return kind_a == kind_b ? a < b : kind_a == NodeKind::kKeyframe;
}

Status Gauge::apply(Graph* graph) {
  if (graph->structure_revision() == structure_revision_) return Status::kOk;
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
    if (!graph->has_node(node)) continue;
    const bool hold = root_of(node) == node;
    if (graph->node(node).fixed == hold) continue;
    const Status status = graph->set_fixed(node, hold);
    if (!is_ok(status)) return status;
  }
  structure_revision_ = graph->structure_revision();
  return Status::kOk;
}

}  // namespace unisim
