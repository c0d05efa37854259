// SPDX-License-Identifier: MIT
// g2o text, SE(3):
//     VERTEX_SE3:QUAT <id> <tx ty tz qx qy qz qw>
//     EDGE_SE3:QUAT <a> <b> <tx ty tz qx qy qz qw> <21 numbers: upper triangle of the information>
//     FIX <id>
#include <Eigen/Cholesky>

#include "tools/bench/solver/pose_graph.hpp"
#include "tools/bench/solver/record_reader.hpp"

namespace unisim::bench {
namespace {

Sim3 read_rigid(RecordReader* record) {
  Sim3 T;
  T.t = record->vector();
  T.q = record->rotation();
  return T;
}

void read_vertex(RecordReader* record, NodeIndex* index, PoseGraph* graph) {
  const int64_t id = record->integer();
  FileNode node;
  node.T_world_node = read_rigid(record);
  if (!index->emplace(id, static_cast<int32_t>(graph->nodes.size())).second) {
    record->fail("vertex " + std::to_string(id) + " is declared twice");
  }
  graph->nodes.push_back(node);
}

void read_edge(RecordReader* record, const NodeIndex& index, PoseGraph* graph) {
  FileEdge edge;
  edge.kind = FileEdgeKind::kRigid;
  edge.a = record->node(index);
  edge.b = record->node(index);
  if (edge.a == edge.b) record->fail("an edge joins a vertex to itself");
  edge.P = read_rigid(record);
  Mat6 information;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      information(row, column) = record->number();
      information(column, row) = information(row, column);
    }
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(information);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0.0)) {
    record->fail("the information matrix is not positive definite");
  }
  edge.information = static_cast<int32_t>(graph->information.size());
  graph->information.push_back(information);
  graph->edges.push_back(edge);
}

void hold_one(PoseGraph* graph) {
  for (const FileNode& node : graph->nodes) {
    if (node.fixed) return;
  }
  if (!graph->nodes.empty()) graph->nodes.front().fixed = true;
}

}  // namespace

PoseGraph read_g2o(const std::string& path) {
  PoseGraph graph;
  NodeIndex index;
  for (const sequence::TextLine& line : sequence::read_lines(path)) {
    RecordReader record(path, line);
    const std::string_view tag = record.word();
    if (tag == "VERTEX_SE3:QUAT") {
      read_vertex(&record, &index, &graph);
    } else if (tag == "EDGE_SE3:QUAT") {
      read_edge(&record, index, &graph);
    } else if (tag == "FIX") {
      graph.nodes[static_cast<size_t>(record.node(index))].fixed = true;
    } else {
      record.fail("'" + std::string(tag) + "' is not read: SE(3) vertices and edges only");
    }
    record.expect_end();
  }
  hold_one(&graph);
  return graph;
}

}  // namespace unisim::bench
