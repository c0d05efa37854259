// SPDX-License-Identifier: MIT
// How long a metre is: evidence by node of the graph, and the metre of each segment as a node.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/fixed_vector.hpp"
#include "core/base/status.hpp"
#include "core/graph/graph.hpp"
#include "core/map/scale_evidence.hpp"
#include "core/snapshot/archive.hpp"

namespace unisim {

/// Segments whose scale can be known at a time; beyond, the one that began first is forgotten.
inline constexpr int32_t kMostMetres = 8;

/// Keeps of each submap's node how many metres its unit has. What was measured in the unit of a
/// submap stays true wherever the submap goes: of a window that retires, a node that merges, a
/// segment that joins another, the evidence goes along.
///
/// In the graph the metre of a segment is a node M (metric.hpp), one metric edge per node with
/// evidence ties it to the map. So the map keeps its unit, nothing jumps when a measurement comes,
/// and submaps whose units disagree with the measurements are drawn back.
class MetricScale {
 public:
  MetricScale() = default;
  /// @param nodes of the graph
  MetricScale(Arena& arena, int32_t nodes)
      : evidence_(arena.take<NodeEvidence>(nodes)), metres_(arena, kMostMetres) {}

  /// Evidence that will not be measured again.
  void add(int32_t node, const ScaleEvidence& evidence);
  /// Evidence of a window whose distances are still known one by one; replaces that given before.
  void set_open(int32_t node, const ScaleEvidence& evidence);
  /// What is open is kept as it is.
  void close(int32_t node);
  /// The unit of the node's submap is another one: e^log_factor of the former.
  void rescale(int32_t node, double log_factor);
  /// Node b is about to become a rigid part of node a.
  /// @param log_scale log of the unit of b over that of a
  /// @param variance  of log_scale
  void merge(int32_t b, int32_t a, double log_scale, double variance);
  /// The node is about to leave the graph.
  void forget(int32_t node);
  /// A segment becomes part of another one: its metre goes, its evidence is for the other's.
  Status release(int32_t segment, Graph* graph);

  /// Bring the edge of a node up to date.
  Status show(int32_t node, int32_t segment, Graph* graph);
  /// Metres that no evidence is left for go.
  Status drop_unused(Graph* graph);
  /// Metric edges are weighed against all others: how sure an information of 1 is there.
  /// Edges follow when it has doubled or halved.
  void set_unit_variance(double variance);
  double unit_variance() const { return unit_variance_; }

  bool empty() const { return !used_; }
  ScaleEvidence evidence(int32_t node) const;
  /// Node of a segment's metre, -1: nothing is known of its scale.
  int32_t metre(int32_t segment) const;
  int32_t metres() const { return metres_.size(); }
  /// Of the metre number k.
  int32_t segment_of(int32_t k) const { return metres_[k].segment; }
  /// With its nodes and edges; what carries evidence is there.
  void visit(Archive* archive, Graph* graph);
  /// By how much the evidence for a metre scatters more than it says, in variance, at least 1.
  double excess(int32_t metre, const Graph& graph) const;
  /// Standard deviation of the log-scale of a segment's metre as it was last asked for, negative:
  /// never. There is a metre.
  double& sigma(int32_t segment) { return metres_[place_of(segment)].sigma; }

 private:
  struct NodeEvidence {
    ScaleEvidence kept;
    ScaleEvidence open;
    double shown_variance = 0.0;  // that the edge was made with
    int32_t edge = -1;
    int32_t metre = -1;  // node at the edge's other end
  };
  struct Metre {
    int32_t segment = -1;
    int32_t node = -1;
    double sigma = -1.0;
  };
  void visit_metres(Archive* archive, Graph* graph);
  void visit_node(Archive* archive, int32_t node, Graph* graph);
  Status give_metre(int32_t segment, double log_units, Graph* graph, int32_t* node);
  Status drop_metre(int32_t place, Graph* graph);
  Status drop_edge(int32_t node, Graph* graph);
  int32_t place_of(int32_t segment) const;

  Span<NodeEvidence> evidence_;
  FixedVector<Metre> metres_;
  double unit_variance_ = 1e-4;  // good residuals are near 0.01
  bool used_ = false;
};

}  // namespace unisim
