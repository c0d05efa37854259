// SPDX-License-Identifier: MIT
// Factor graph on Sim(3) in arena memory.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/fixed_vector.hpp"
#include "core/base/status.hpp"
#include "core/graph/chain.hpp"
#include "core/graph/edge.hpp"
#include "core/graph/rigid.hpp"
#include "core/snapshot/archive.hpp"

namespace unisim {

/// Largest numbers a graph holds at a time.
struct GraphCapacity {
  int32_t nodes = 0;
  int32_t edges = 0;
  int32_t measurements = 0;  ///< 1 per two_view, bridge, chain and rigid edge, 2 per tie and rigid
                             ///< bridge edge, 0 per scale edge
  int32_t chains = 0;        ///< chain and rigid edges among the edges
};

/// Bits of what happened to a node.
enum NodeChange : uint8_t {
  kNodeMoved = 1,     ///< its pose: what its edges say has changed at both ends
  kNodeRelinked = 2,  ///< an edge of it came, went or got other numbers
  kNodeHeld = 4       ///< whether it is held, or its kind: its edges may add to other columns
};

/// Nodes (poses) and edges (factors), addressed by ids that stay until the item is removed; ids of
/// removed items are used again. Calls that fail leave the graph as it was.
class Graph {
 public:
  Graph() = default;
  Graph(Arena& arena, const GraphCapacity& capacity);

  /// Remove everything.
  void clear();

  // ---- nodes
  /// @return kOk; kInvalidArgument for a pose that is not valid(); kCapacity
  Status add_node(NodeKind kind, const Sim3& T_world_node, int32_t* id);
  /// Remove a node and all its edges. Linear in edges. kInvalidArgument for an unknown id.
  Status remove_node(int32_t id);
  /// Hold or release a pose (gauge: hold one node of each connected component).
  Status set_fixed(int32_t id, bool fixed);
  Status set_kind(int32_t id, NodeKind kind);
  Status set_pose(int32_t id, const Sim3& T_world_node);
  bool has_node(int32_t id) const;
  const Node& node(int32_t id) const { return nodes_[id]; }
  const Sim3& pose(int32_t id) const { return nodes_[id].T_world_node; }
  /// Ids are below this; slots of removed nodes are not alive.
  int32_t node_end() const { return nodes_.size(); }
  int32_t node_count() const { return node_count_; }

  // ---- edges: a is the first node of the factor's formula, b the second
  /// @param Z_i_j two_view_measurement()
  /// @return kOk; kInvalidArgument: unknown or equal nodes, bad pose or weight; kCapacity
  Status add_two_view(int32_t i, int32_t j, const Sim3& Z_i_j, const EdgeWeight& weight,
                      int32_t* id);
  /// @param Z_m_i bridge_measurement()
  Status add_bridge(int32_t submap, int32_t keyframe, const Sim3& Z_m_i, const EdgeWeight& weight,
                    int32_t* id);
  /// Bridge to a keyframe that has no node: rigid under the node of another submap, its owner.
  Status add_rigid_bridge(int32_t submap, int32_t owner, const Sim3& Z_m_i, const Sim3& T_owner_kf,
                          const EdgeWeight& weight, int32_t* id);
  /// @param P tie_measurement()
  Status add_tie(int32_t m, int32_t n, const Sim3& P, const Sim3& T_submap_n_kf,
                 const EdgeWeight& weight, int32_t* id);
  /// @param log_rho_mi log of the depth ratio, finite
  Status add_scale_anchor(int32_t submap, int32_t keyframe, double log_rho_mi,
                          const EdgeWeight& weight, int32_t* id);
  Status add_scale(int32_t m, int32_t n, double log_c, const EdgeWeight& weight, int32_t* id);
  /// @param metre node of kind kMetre, which has no other edges
  Status add_metric(int32_t metre, int32_t submap, double log_metres, const EdgeWeight& weight,
                    int32_t* id);
  /// @return kInvalidArgument also for an information that is not positive definite
  Status add_chain(int32_t a, int32_t b, const ChainLink& link, const EdgeWeight& weight,
                   int32_t* id);
  /// Nothing depends on the log-scales of a and b: in a graph of rigid edges alone they stay.
  /// @param Lambda information of rigid_residual(), symmetric, positive definite
  /// @return kInvalidArgument also for a scale of Z_a_b other than 1
  Status add_rigid(int32_t a, int32_t b, const Sim3& Z_a_b, const Mat6& Lambda,
                   const EdgeWeight& weight, int32_t* id);
  Status remove_edge(int32_t id);

  /// Put a new measurement into a two_view or bridge edge.
  Status set_measurement(int32_t id, const Sim3& Z);
  /// Put new measurements into a tie or rigid bridge edge.
  Status set_tie_measurement(int32_t id, const Sim3& P, const Sim3& T_submap_n_kf);
  /// Put a new log ratio into a scale_anchor, scale or metric edge.
  Status set_log_ratio(int32_t id, double log_ratio);
  Status set_multiplier(int32_t id, double multiplier);
  /// A suspended edge keeps its id and place but contributes nothing.
  Status set_suspended(int32_t id, bool suspended);

  bool has_edge(int32_t id) const;
  const Edge& edge(int32_t id) const { return edges_[id]; }
  int32_t edge_end() const { return edges_.size(); }
  int32_t edge_count() const { return edge_count_; }
  const Sim3& measurement(int32_t slot) const { return measurements_[slot]; }

  const Mat7& information(int32_t slot) const { return informations_[slot]; }
  /// What a chain edge holds.
  ChainLink link(const Edge& edge) const;

  /// Whitened norm u of an edge at the present poses, suspended or not.
  double edge_norm(int32_t id) const;
  /// Sum of rho(u) over active edges.
  double cost() const;

  /// Grows when nodes, edges or fixed flags change: the structure of the system is another one.
  uint64_t structure_revision() const { return structure_revision_; }
  /// Grows with that, and when edges are suspended or come back.
  uint64_t activity_revision() const { return activity_revision_; }
  /// Grows with every change, poses and measurements included.
  uint64_t revision() const { return revision_; }

  /// What has changed at a node since the graph had this revision: bits of NodeChange. Removed
  /// nodes count.
  uint8_t changes_since(int32_t id, uint64_t revision) const {
    const NodeStamps& stamps = stamps_[id];
    return static_cast<uint8_t>((stamps.moved > revision ? kNodeMoved : 0) |
                                (stamps.relinked > revision ? kNodeRelinked : 0) |
                                (stamps.held > revision ? kNodeHeld : 0));
  }
  /// Whether an edge may say something else than at this revision; edges come and go with their
  /// nodes relinked.
  bool edge_changed_since(int32_t id, uint64_t revision) const {
    return (changes_since(edges_[id].a, revision) | changes_since(edges_[id].b, revision)) != 0;
  }

  // ---- saving and loading (graph_snapshot.cpp); into a graph that is empty
  // Nodes and edges are visited by those they belong to: to load, each slot is taken once, and the
  // order in which slots will be used again is kept, on which the order of all sums depends.
  void visit_sizes(Archive* archive);
  /// A node of this kind.
  void visit_node(Archive* archive, NodeKind kind, int32_t* id);
  /// An edge of this kind, or none (-1); its nodes are there.
  void visit_edge(Archive* archive, FactorKind kind, int32_t* id);
  /// The same from node a to node b.
  void visit_edge(Archive* archive, FactorKind kind, int32_t a, int32_t b, int32_t* id);
  /// Edges of this kind and origin, which belong to nobody.
  void visit_edges(Archive* archive, FactorKind kind, EdgeOrigin origin);
  /// Slots that are free; all others have been visited.
  void visit_free_slots(Archive* archive);

 private:
  /// Revisions in which things happened to a node.
  struct NodeStamps {
    uint64_t moved = 0;
    uint64_t relinked = 0;
    uint64_t held = 0;
  };

  /// Revision that the change being made will have.
  uint64_t next_revision() const { return revision_ + 1; }
  void note_relinked(const Edge& edge);
  Status add_edge(const Edge& edge, int32_t* id);
  Status add_pose_edge(FactorKind kind, int32_t a, int32_t b, const Sim3& P, const Sim3* Q,
                       const EdgeWeight& weight, int32_t* id);
  Status add_scale_edge(FactorKind kind, int32_t a, int32_t b, double log_ratio,
                        const EdgeWeight& weight, int32_t* id);
  Status add_informed_edge(FactorKind kind, int32_t a, int32_t b, const ChainLink& link,
                           const EdgeWeight& weight, int32_t* id);
  bool joins_two_nodes(int32_t a, int32_t b) const;
  int32_t take_measurement(const Sim3& value);
  void release_edge(int32_t id);
  void structure_changed();
  void expect_first_pair(Archive* archive, int32_t id);
  void visit_measurements(Archive* archive, Edge* edge);
  void visit_measurement(Archive* archive, int32_t* slot);
  void visit_information(Archive* archive, int32_t* slot);

  FixedVector<Node> nodes_;
  FixedVector<int32_t> free_nodes_;
  Span<NodeStamps> stamps_;
  FixedVector<Edge> edges_;
  FixedVector<int32_t> free_edges_;
  FixedVector<Sim3> measurements_;
  FixedVector<int32_t> free_measurements_;
  FixedVector<Mat7> informations_;
  FixedVector<int32_t> free_informations_;
  uint32_t next_serial_ = 0;
  int32_t node_count_ = 0;
  int32_t edge_count_ = 0;
  uint64_t structure_revision_ = 1;
  uint64_t activity_revision_ = 1;
  uint64_t revision_ = 1;
};

/// Numbers finite, information and width of the kernel > 0, multiplier >= 0.
bool valid_weight(const EdgeWeight& weight);

/// u^2 of an edge at the present poses.
double edge_norm_squared(const Graph& graph, const Edge& edge);

/// e of an edge at the given poses; rows that its factor lacks are zero.
Vec7 edge_residual(const Graph& graph, const Edge& edge);

}  // namespace unisim
