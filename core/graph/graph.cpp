// SPDX-License-Identifier: MIT
// Factor graph on Sim(3) in arena memory.
#include "core/graph/graph.hpp"

#include <cmath>

#include "core/graph/relative_pose.hpp"
#include "core/graph/scale_ratio.hpp"
#include "core/graph/slots.hpp"

namespace unisim {
bool valid_weight(const EdgeWeight& weight) {
  return std::isfinite(weight.information) && weight.information > 0.0 &&
         std::isfinite(weight.multiplier) && weight.multiplier >= 0.0 &&
         (weight.kernel.kind == RobustKernelKind::kNone ||
          (std::isfinite(weight.kernel.delta) && weight.kernel.delta > 0.0));
}

Graph::Graph(Arena& arena, const GraphCapacity& capacity)
    : nodes_(arena, capacity.nodes),
      free_nodes_(arena, capacity.nodes),
      stamps_(arena.take<NodeStamps>(capacity.nodes)),
      edges_(arena, capacity.edges),
      free_edges_(arena, capacity.edges),
      measurements_(arena, capacity.measurements),
      free_measurements_(arena, capacity.measurements),
      informations_(arena, capacity.chains),
      free_informations_(arena, capacity.chains) {}

void Graph::clear() {
  stamps_.fill({next_revision(), next_revision(), 0});
  nodes_.clear();
  free_nodes_.clear();
  edges_.clear();
  free_edges_.clear();
  measurements_.clear();
  free_measurements_.clear();
  informations_.clear();
  free_informations_.clear();
  next_serial_ = 0;
  node_count_ = 0;
  edge_count_ = 0;
  structure_changed();
}

void Graph::note_relinked(const Edge& edge) {
  stamps_[edge.a].relinked = next_revision();
  stamps_[edge.b].relinked = next_revision();
}

void Graph::structure_changed() {
  ++structure_revision_;
  ++activity_revision_;
  ++revision_;
}

bool Graph::has_node(int32_t id) const { return id >= 0 && id < nodes_.size() && nodes_[id].alive; }

bool Graph::has_edge(int32_t id) const { return id >= 0 && id < edges_.size() && edges_[id].alive; }

Status Graph::add_node(NodeKind kind, const Sim3& T_world_node, int32_t* id) {
  if (!T_world_node.valid()) return Status::kInvalidArgument;
  if (room(nodes_, free_nodes_) == 0) return Status::kCapacity;
  *id = take_slot(&nodes_, &free_nodes_);
  nodes_[*id] = Node{T_world_node, next_serial_++, kind, false, true};
  ++node_count_;
  stamps_[*id] = {next_revision(), next_revision(), 0};
  structure_changed();
  return Status::kOk;
}

Status Graph::remove_node(int32_t id) {
  if (!has_node(id)) return Status::kInvalidArgument;
  for (int32_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i].alive && (edges_[i].a == id || edges_[i].b == id)) release_edge(i);
  }
  nodes_[id].alive = false;
  stamps_[id].relinked = next_revision();
  give_back(&free_nodes_, id);
  --node_count_;
  structure_changed();
  return Status::kOk;
}

Status Graph::set_fixed(int32_t id, bool fixed) {
  if (!has_node(id)) return Status::kInvalidArgument;
  if (nodes_[id].fixed == fixed) return Status::kOk;
  nodes_[id].fixed = fixed;
  stamps_[id].held = stamps_[id].relinked = next_revision();
  structure_changed();
  return Status::kOk;
}

Status Graph::set_kind(int32_t id, NodeKind kind) {
  if (!has_node(id)) return Status::kInvalidArgument;
  nodes_[id].kind = kind;
  stamps_[id].held = stamps_[id].relinked = next_revision();
  structure_changed();
  return Status::kOk;
}

Status Graph::set_pose(int32_t id, const Sim3& T_world_node) {
  if (!has_node(id) || !T_world_node.valid()) return Status::kInvalidArgument;
  nodes_[id].T_world_node = T_world_node;
  stamps_[id].moved = next_revision();
  ++revision_;
  return Status::kOk;
}

bool Graph::joins_two_nodes(int32_t a, int32_t b) const {
  return a != b && has_node(a) && has_node(b);
}

int32_t Graph::take_measurement(const Sim3& value) {
  const int32_t slot = take_slot(&measurements_, &free_measurements_);
  measurements_[slot] = value;
  return slot;
}

Status Graph::add_edge(const Edge& edge, int32_t* id) {
  *id = take_slot(&edges_, &free_edges_);
  edges_[*id] = edge;
  edges_[*id].alive = true;
  ++edge_count_;
  note_relinked(edge);
  structure_changed();
  return Status::kOk;
}

Status Graph::add_pose_edge(FactorKind kind, int32_t a, int32_t b, const Sim3& P, const Sim3* Q,
                            const EdgeWeight& weight, int32_t* id) {
  const bool valid = joins_two_nodes(a, b) && P.valid() && (Q == nullptr || Q->valid());
  if (!valid || !valid_weight(weight)) return Status::kInvalidArgument;
  const int32_t slots = Q == nullptr ? 1 : 2;
  if (room(edges_, free_edges_) == 0 || room(measurements_, free_measurements_) < slots) {
    return Status::kCapacity;
  }
  Edge edge;
  edge.kind = kind;
  edge.a = a;
  edge.b = b;
  edge.information = weight.information;
  edge.multiplier = weight.multiplier;
  edge.kernel = weight.kernel;
  edge.origin = weight.origin;
  edge.P = take_measurement(P);
  edge.Q = Q == nullptr ? -1 : take_measurement(*Q);
  return add_edge(edge, id);
}

Status Graph::add_scale_edge(FactorKind kind, int32_t a, int32_t b, double log_ratio,
                             const EdgeWeight& weight, int32_t* id) {
  if (!joins_two_nodes(a, b) || !std::isfinite(log_ratio) || !valid_weight(weight)) {
    return Status::kInvalidArgument;
  }
  if (room(edges_, free_edges_) == 0) return Status::kCapacity;
  Edge edge;
  edge.kind = kind;
  edge.a = a;
  edge.b = b;
  edge.information = weight.information;
  edge.multiplier = weight.multiplier;
  edge.kernel = weight.kernel;
  edge.origin = weight.origin;
  edge.log_ratio = log_ratio;
  return add_edge(edge, id);
}

Status Graph::add_two_view(int32_t i, int32_t j, const Sim3& Z_i_j, const EdgeWeight& weight,
                           int32_t* id) {
  return add_pose_edge(FactorKind::kTwoView, i, j, Z_i_j, nullptr, weight, id);
}

Status Graph::add_bridge(int32_t submap, int32_t keyframe, const Sim3& Z_m_i,
                         const EdgeWeight& weight, int32_t* id) {
  return add_pose_edge(FactorKind::kBridge, submap, keyframe, Z_m_i, nullptr, weight, id);
}

Status Graph::add_rigid_bridge(int32_t submap, int32_t owner, const Sim3& Z_m_i,
                               const Sim3& T_owner_kf, const EdgeWeight& weight, int32_t* id) {
  return add_pose_edge(FactorKind::kBridge, submap, owner, Z_m_i, &T_owner_kf, weight, id);
}

Status Graph::add_tie(int32_t m, int32_t n, const Sim3& P, const Sim3& T_submap_n_kf,
                      const EdgeWeight& weight, int32_t* id) {
  return add_pose_edge(FactorKind::kTie, m, n, P, &T_submap_n_kf, weight, id);
}

Status Graph::add_scale_anchor(int32_t submap, int32_t keyframe, double log_rho_mi,
                               const EdgeWeight& weight, int32_t* id) {
  return add_scale_edge(FactorKind::kScaleAnchor, submap, keyframe, log_rho_mi, weight, id);
}

Status Graph::add_scale(int32_t m, int32_t n, double log_c, const EdgeWeight& weight, int32_t* id) {
  return add_scale_edge(FactorKind::kScale, m, n, log_c, weight, id);
}

Status Graph::add_metric(int32_t metre, int32_t submap, double log_metres, const EdgeWeight& weight,
                         int32_t* id) {
  return add_scale_edge(FactorKind::kMetric, metre, submap, log_metres, weight, id);
}

Status Graph::add_informed_edge(FactorKind kind, int32_t a, int32_t b, const ChainLink& link,
                                const EdgeWeight& weight, int32_t* id) {
  if (!valid_link(link)) return Status::kInvalidArgument;
  if (room(informations_, free_informations_) == 0) return Status::kCapacity;
  const Status status = add_pose_edge(kind, a, b, link.Z_a_b, nullptr, weight, id);
  if (!is_ok(status)) return status;
  edges_[*id].Lambda = take_slot(&informations_, &free_informations_);
  informations_[edges_[*id].Lambda] = link.Lambda;
  return Status::kOk;
}

Status Graph::add_chain(int32_t a, int32_t b, const ChainLink& link, const EdgeWeight& weight,
                        int32_t* id) {
  return add_informed_edge(FactorKind::kChain, a, b, link, weight, id);
}

// The row of the log-scale is there for the shape only: its residual is zero.
Status Graph::add_rigid(int32_t a, int32_t b, const Sim3& Z_a_b, const Mat6& Lambda,
                        const EdgeWeight& weight, int32_t* id) {
  if (Z_a_b.s != 1.0) return Status::kInvalidArgument;
  ChainLink link{Z_a_b, Mat7::Identity()};
  link.Lambda.topLeftCorner<6, 6>() = Lambda;
  return add_informed_edge(FactorKind::kRigid, a, b, link, weight, id);
}

ChainLink Graph::link(const Edge& edge) const {
  return {measurements_[edge.P], informations_[edge.Lambda]};
}

void Graph::release_edge(int32_t id) {
  Edge& edge = edges_[id];
  note_relinked(edge);
  if (edge.P >= 0) give_back(&free_measurements_, edge.P);
  if (edge.Q >= 0) give_back(&free_measurements_, edge.Q);
  if (edge.Lambda >= 0) give_back(&free_informations_, edge.Lambda);
  edge = Edge();
  give_back(&free_edges_, id);
  --edge_count_;
}

Status Graph::remove_edge(int32_t id) {
  if (!has_edge(id)) return Status::kInvalidArgument;
  release_edge(id);
  structure_changed();
  return Status::kOk;
}

Status Graph::set_measurement(int32_t id, const Sim3& Z) {
  if (!has_edge(id) || edges_[id].P < 0 || edges_[id].Q >= 0 || !Z.valid()) {
    return Status::kInvalidArgument;
  }
  measurements_[edges_[id].P] = Z;
  note_relinked(edges_[id]);
  ++revision_;
  return Status::kOk;
}

Status Graph::set_tie_measurement(int32_t id, const Sim3& P, const Sim3& T_submap_n_kf) {
  if (!has_edge(id) || edges_[id].Q < 0 || !P.valid() || !T_submap_n_kf.valid()) {
    return Status::kInvalidArgument;
  }
  measurements_[edges_[id].P] = P;
  measurements_[edges_[id].Q] = T_submap_n_kf;
  note_relinked(edges_[id]);
  ++revision_;
  return Status::kOk;
}

Status Graph::set_log_ratio(int32_t id, double log_ratio) {
  if (!has_edge(id) || edges_[id].P >= 0 || !std::isfinite(log_ratio)) {
    return Status::kInvalidArgument;
  }
  edges_[id].log_ratio = log_ratio;
  note_relinked(edges_[id]);
  ++revision_;
  return Status::kOk;
}

Status Graph::set_multiplier(int32_t id, double multiplier) {
  if (!has_edge(id) || !std::isfinite(multiplier) || multiplier < 0.0) {
    return Status::kInvalidArgument;
  }
  edges_[id].multiplier = multiplier;
  note_relinked(edges_[id]);
  ++revision_;
  return Status::kOk;
}

Status Graph::set_suspended(int32_t id, bool suspended) {
  if (!has_edge(id)) return Status::kInvalidArgument;
  if (edges_[id].suspended != suspended) ++activity_revision_;
  edges_[id].suspended = suspended;
  note_relinked(edges_[id]);
  ++revision_;
  return Status::kOk;
}

Vec7 edge_residual(const Graph& graph, const Edge& edge) {
  const Sim3& A = graph.pose(edge.a);
  const Sim3& B = graph.pose(edge.b);
  Vec7 e = Vec7::Zero();
  if (edge.kind == FactorKind::kRigid) {
    e.head<6>() = rigid_residual(A, B, graph.measurement(edge.P));
    return e;
  }
  if (is_pose_factor(edge.kind)) {
    const Sim3 Q = edge.Q < 0 ? Sim3() : graph.measurement(edge.Q);
    return relative_pose_residual(A, B, graph.measurement(edge.P), Q);
  }
  e(0) = scale_ratio_residual(A, B, edge.log_ratio);
  return e;
}

double edge_norm_squared(const Graph& graph, const Edge& edge) {
  const Vec7 e = edge_residual(graph, edge);
  if (edge.Lambda < 0) return edge.weight() * e.squaredNorm();
  return edge.weight() * e.dot(graph.information(edge.Lambda) * e);
}

double Graph::edge_norm(int32_t id) const {
  return std::sqrt(edge_norm_squared(*this, edges_[id]));
}

double Graph::cost() const {
  double cost = 0.0;
  for (const Edge& edge : edges_) {
    if (!edge.active()) continue;
    cost += robust_cost(edge.kernel, edge_norm_squared(*this, edge)).cost;
  }
  return cost;
}

}  // namespace unisim
