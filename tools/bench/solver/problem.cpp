// SPDX-License-Identifier: MIT
// A graph of a file as the solver of the core holds it.
#include "tools/bench/solver/problem.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "tools/common/failure.hpp"

namespace unisim::bench {
namespace {

using tools::Failure;

// The file's Huber width is on |e|, the core's on sqrt(weight) |e|: the cost is the same.
EdgeWeight weight_of(const FileEdge& edge) {
  EdgeWeight weight;
  weight.information = edge.weight;
  if (edge.huber > 0.0) {
    weight.kernel = {RobustKernelKind::kHuber, edge.huber * std::sqrt(edge.weight)};
  }
  return weight;
}

Status add(const PoseGraph& source, const FileEdge& edge, Graph* graph) {
  int32_t id = -1;
  const EdgeWeight weight = weight_of(edge);
  switch (edge.kind) {
    case FileEdgeKind::kTwoView:
      return graph->add_two_view(edge.a, edge.b, edge.P, weight, &id);
    case FileEdgeKind::kBridge:
      return graph->add_bridge(edge.a, edge.b, edge.P, weight, &id);
    case FileEdgeKind::kTie:
      return graph->add_tie(edge.a, edge.b, edge.P, edge.Q, weight, &id);
    case FileEdgeKind::kScaleAnchor:
      return graph->add_scale_anchor(edge.a, edge.b, edge.log_ratio, weight, &id);
    case FileEdgeKind::kScale:
      return graph->add_scale(edge.a, edge.b, edge.log_ratio, weight, &id);
    case FileEdgeKind::kRigid:
      return graph->add_rigid(edge.a, edge.b, edge.P,
                              source.information[static_cast<size_t>(edge.information)], weight,
                              &id);
  }
  return Status::kInvalidArgument;
}

void expect_ok(Status status, const std::string& where) {
  if (is_ok(status)) return;
  throw Failure(tools::kExitInput,
                where + " is refused by the solver: check its numbers and its weight");
}

int32_t measurements_of(const PoseGraph& source) {
  int32_t count = 0;
  for (const FileEdge& edge : source.edges) count += edge.kind == FileEdgeKind::kTie ? 2 : 1;
  return count;
}

}  // namespace

// The structure tells once it is analysed: a solver declared too small asks for what it needs.
int32_t needed_factor_blocks(const PoseGraph& source) {
  Problem problem(source, 1);
  LmOptions options;
  options.max_iterations = 0;
  LmReport report;
  if (problem.solver().optimize(&problem.graph(), options, &report) != Status::kCapacity) return 1;
  if (report.factor_blocks > std::numeric_limits<int32_t>::max()) {
    throw Failure(tools::kExitLimit, "the factor of this graph has too many blocks");
  }
  return static_cast<int32_t>(report.factor_blocks);
}

Problem::Problem(const PoseGraph& source, int32_t factor_blocks, Empty) {
  const int32_t nodes = static_cast<int32_t>(source.nodes.size());
  const int32_t edges = static_cast<int32_t>(source.edges.size());
  const GraphCapacity graph_capacity{nodes, edges, measurements_of(source),
                                     static_cast<int32_t>(source.information.size())};
  const SolverCapacity solver_capacity{nodes, edges, edges, factor_blocks};
  Arena dry;
  Graph counted_graph(dry, graph_capacity);
  LevenbergMarquardt counted_solver(dry, solver_capacity);
  memory_ = std::vector<unsigned char>(dry.required_bytes());
  Arena arena(memory_.data(), memory_.size());
  graph_ = Graph(arena, graph_capacity);
  solver_ = LevenbergMarquardt(arena, solver_capacity);
}

Problem::Problem(const PoseGraph& source, int32_t factor_blocks)
    : Problem(source, factor_blocks, Empty()) {
  for (const FileNode& node : source.nodes) add_node(node);
  for (const FileEdge& edge : source.edges) add_edge(source, edge);
}

void Problem::add_node(const FileNode& node) {
  const NodeKind kind = node.submap ? NodeKind::kSubmap : NodeKind::kKeyframe;
  int32_t id = -1;
  Status status = graph_.add_node(kind, node.T_world_node, &id);
  if (is_ok(status)) status = graph_.set_fixed(id, node.fixed);
  expect_ok(status, "node " + std::to_string(graph_.node_count()) + " of the file");
}

void Problem::add_edge(const PoseGraph& source, const FileEdge& edge) {
  expect_ok(add(source, edge, &graph_),
            "edge " + std::to_string(graph_.edge_count() + 1) + " of the file");
}

}  // namespace unisim::bench
