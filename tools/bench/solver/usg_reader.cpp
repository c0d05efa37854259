// SPDX-License-Identifier: MIT
// Text format usg 1:
//     node <id> <T|S> <fixed 0|1> <qx qy qz qw tx ty tz s>
//     edge <v2v|bridge> <a> <b> <weight> <huber> <qx qy qz qw tx ty tz s>
//     edge tie <a> <b> <weight> <huber> <8 numbers> <8 numbers>
//     edge <anchor|scale> <a> <b> <weight> <huber> <log ratio>
#include "tools/bench/solver/pose_graph.hpp"
#include "tools/bench/solver/record_reader.hpp"

namespace unisim::bench {
namespace {

Sim3 read_similarity(RecordReader* record) {
  Sim3 T;
  T.q = record->rotation();
  T.t = record->vector();
  T.s = record->number();
  if (!(T.s > 0.0)) record->fail("a scale is not above zero");
  return T;
}

void read_node(RecordReader* record, NodeIndex* index, PoseGraph* graph) {
  const int64_t id = record->integer();
  const std::string_view kind = record->word();
  if (kind != "T" && kind != "S") record->fail("node kind is T (keyframe) or S (submap)");
  FileNode node;
  node.submap = kind == "S";
  node.fixed = record->integer() != 0;
  node.T_world_node = read_similarity(record);
  if (!index->emplace(id, static_cast<int32_t>(graph->nodes.size())).second) {
    record->fail("node " + std::to_string(id) + " is declared twice");
  }
  graph->nodes.push_back(node);
}

FileEdgeKind edge_kind(std::string_view name, const RecordReader& record) {
  if (name == "v2v") return FileEdgeKind::kTwoView;
  if (name == "bridge") return FileEdgeKind::kBridge;
  if (name == "tie") return FileEdgeKind::kTie;
  if (name == "anchor") return FileEdgeKind::kScaleAnchor;
  if (name == "scale") return FileEdgeKind::kScale;
  record.fail("edge type '" + std::string(name) + "' is not v2v, bridge, tie, anchor or scale");
}

void read_edge(RecordReader* record, const NodeIndex& index, PoseGraph* graph) {
  FileEdge edge;
  edge.kind = edge_kind(record->word(), *record);
  edge.a = record->node(index);
  edge.b = record->node(index);
  if (edge.a == edge.b) record->fail("an edge joins a node to itself");
  edge.weight = record->number();
  if (!(edge.weight > 0.0)) record->fail("a weight is not above zero");
  edge.huber = record->number();
  if (edge.kind == FileEdgeKind::kScaleAnchor || edge.kind == FileEdgeKind::kScale) {
    edge.log_ratio = record->number();
  } else {
    edge.P = read_similarity(record);
    if (edge.kind == FileEdgeKind::kTie) edge.Q = read_similarity(record);
  }
  graph->edges.push_back(edge);
}

}  // namespace

PoseGraph read_usg(const std::string& path) {
  PoseGraph graph;
  NodeIndex index;
  for (const sequence::TextLine& line : sequence::read_lines(path)) {
    RecordReader record(path, line);
    const std::string_view tag = record.word();
    if (tag == "node") {
      read_node(&record, &index, &graph);
    } else if (tag == "edge") {
      read_edge(&record, index, &graph);
    } else {
      record.fail("a line starts with node, edge or #");
    }
    record.expect_end();
  }
  return graph;
}

}  // namespace unisim::bench
