// SPDX-License-Identifier: MIT
// A factor graph saved and loaded, slot by slot.

#include "core/graph/graph.hpp"
#include "core/graph/slots.hpp"

namespace unisim {
namespace {

/// Ids in the order in which they will be used again; is_free(id): not in use and not seen yet,
/// which it marks.
template <class IsFree>
void visit_slots(Archive* archive, FixedVector<int32_t>* slots, int32_t count, int32_t end,
                 const IsFree& is_free) {
  if (archive->loading()) slots->resize(count);
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    archive->index(&(*slots)[k], 0, end - 1);
    if (archive->loading() && archive->ok()) archive->expect(is_free((*slots)[k]));
  }
}

void visit_kernel(Archive* archive, RobustKernel* kernel) {
  archive->choice(&kernel->kind, RobustKernelKind::kGemanMcClure);
  archive->finite(&kernel->delta);
  archive->expect(kernel->delta > 0.0);
}

}  // namespace

void Graph::visit_sizes(Archive* archive) {
  int32_t nodes = nodes_.size();
  int32_t edges = edges_.size();
  archive->index(&nodes, 0, kMostId);
  archive->index(&edges, 0, kMostId);
  archive->value(&next_serial_);
  // All else that decides these lengths is checked by name.
  archive->need("max_loops", nodes, nodes_.capacity());
  archive->need("max_loops", edges, edges_.capacity());
  if (!archive->loading() || !archive->ok()) return;
  nodes_.resize(nodes);
  nodes_.span().fill(Node());
  edges_.resize(edges);
  edges_.span().fill(Edge());
}

void Graph::visit_node(Archive* archive, NodeKind kind, int32_t* id) {
  archive->index(id, 0, nodes_.size() - 1);
  if (!archive->ok()) return;
  Node& node = nodes_[*id];
  archive->expect(!node.alive);
  archive->pose(&node.T_world_node);
  archive->value(&node.serial);
  archive->flag(&node.fixed);
  if (!archive->loading() || !archive->ok()) return;
  node.kind = kind;
  node.alive = true;
  ++node_count_;
}

void Graph::visit_measurement(Archive* archive, int32_t* slot) {
  Sim3 T;
  if (!archive->loading()) T = measurements_[*slot];
  archive->pose(&T);
  archive->expect(room(measurements_, free_measurements_) > 0);
  if (archive->loading() && archive->ok()) *slot = take_measurement(T);
}

void Graph::visit_information(Archive* archive, int32_t* slot) {
  Mat7 Lambda = Mat7::Identity();
  if (!archive->loading()) Lambda = informations_[*slot];
  for (int k = 0; k < Lambda.size(); ++k) archive->value(&Lambda.data()[k]);
  archive->expect(valid_link({Sim3(), Lambda}));
  archive->expect(room(informations_, free_informations_) > 0);
  if (!archive->loading() || !archive->ok()) return;
  *slot = take_slot(&informations_, &free_informations_);
  informations_[*slot] = Lambda;
}

/// What the kind of the edge calls for.
void Graph::visit_measurements(Archive* archive, Edge* edge) {
  if (!is_pose_factor(edge->kind)) {
    archive->finite(&edge->log_ratio);
    return;
  }
  visit_measurement(archive, &edge->P);
  bool rigid = edge->Q >= 0;
  if (edge->kind == FactorKind::kBridge) archive->flag(&rigid);
  if (rigid || edge->kind == FactorKind::kTie) visit_measurement(archive, &edge->Q);
  if (edge->kind == FactorKind::kChain) visit_information(archive, &edge->Lambda);
}

void Graph::visit_edge(Archive* archive, FactorKind kind, int32_t* id) {
  archive->index(id, -1, edges_.size() - 1);
  if (!archive->ok() || *id < 0) return;
  Edge edge = edges_[*id];
  archive->expect(!edge.alive);
  if (archive->loading()) edge = Edge();
  edge.kind = kind;
  archive->index(&edge.a, 0, nodes_.size() - 1);
  archive->index(&edge.b, 0, nodes_.size() - 1);
  archive->value(&edge.information);
  archive->value(&edge.multiplier);
  visit_kernel(archive, &edge.kernel);
  archive->choice(&edge.origin, EdgeOrigin::kLoop);
  archive->flag(&edge.suspended);
  archive->expect(archive->ok() && joins_two_nodes(edge.a, edge.b));
  archive->expect(valid_weight(edge.given_weight()));
  visit_measurements(archive, &edge);
  if (!archive->loading() || !archive->ok()) return;
  edge.alive = true;
  edges_[*id] = edge;
  ++edge_count_;
}

void Graph::visit_edge(Archive* archive, FactorKind kind, int32_t a, int32_t b, int32_t* id) {
  visit_edge(archive, kind, id);
  if (archive->ok() && *id >= 0) archive->expect(edges_[*id].a == a && edges_[*id].b == b);
}

void Graph::visit_edges(Archive* archive, FactorKind kind, EdgeOrigin origin) {
  const auto belongs = [&](int32_t id) {
    return edges_[id].alive && edges_[id].kind == kind && edges_[id].origin == origin;
  };
  int32_t count = 0;
  if (!archive->loading()) {
    for (int32_t id = 0; id < edges_.size(); ++id) count += belongs(id) ? 1 : 0;
  }
  archive->index(&count, 0, edges_.size());
  int32_t next = 0;
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    while (!archive->loading() && !belongs(next)) ++next;
    int32_t id = next++;
    visit_edge(archive, kind, &id);
    archive->expect(archive->ok() && id >= 0 && belongs(id));
    if (kind == FactorKind::kTwoView) expect_first_pair(archive, id);
  }
}

/// To load: no other pair ends at this keyframe. Marks it.
void Graph::expect_first_pair(Archive* archive, int32_t id) {
  if (!archive->loading() || !archive->ok()) return;
  const Edge& edge = edges_[id];
  archive->expect(nodes_[edge.a].kind == NodeKind::kKeyframe);
  archive->expect(nodes_[edge.b].kind == NodeKind::kKeyframe && stamps_[edge.b].held == 0);
  stamps_[edge.b].held = 1;
}

void Graph::visit_free_slots(Archive* archive) {
  // Marks on what is free: a node held, an edge suspended.
  visit_slots(archive, &free_nodes_, nodes_.size() - node_count_, nodes_.size(), [&](int32_t id) {
    const bool is_free = !nodes_[id].alive && !nodes_[id].fixed;
    nodes_[id].fixed = true;
    return is_free;
  });
  visit_slots(archive, &free_edges_, edges_.size() - edge_count_, edges_.size(), [&](int32_t id) {
    const bool is_free = !edges_[id].alive && !edges_[id].suspended;
    edges_[id].suspended = true;
    return is_free;
  });
  if (!archive->loading() || !archive->ok()) return;
  for (const int32_t id : free_nodes_) nodes_[id].fixed = false;
  for (const int32_t id : free_edges_) edges_[id].suspended = false;
  stamps_.fill({next_revision(), next_revision(), 0});
  structure_changed();
}

}  // namespace unisim
