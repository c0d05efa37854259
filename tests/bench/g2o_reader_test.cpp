// SPDX-License-Identifier: MIT
// Reader of g2o SE(3) graphs.
#include "drivers/sequence/text_file.hpp"
#include "tests/bench/graph_of.hpp"
#include "tests/support/catch.hpp"

using namespace unisim;
using namespace unisim::bench;

namespace {

const std::string kVertices =
    "VERTEX_SE3:QUAT 5 1 2 3 0 0 0 1\n"
    "VERTEX_SE3:QUAT 9 4 5 6 0 0 1 0\n";
const std::string kEdge =
    "EDGE_SE3:QUAT 5 9 1 0 0 0 0 0 1 "
    "10 0.5 0 0 0 0 11 0 0 0 0 12 0 0 0 13 0 0 14 0 15\n";

PoseGraph read(const std::string& content) { return graph_of(content, "graph.g2o"); }

}  // namespace

TEST_CASE("vertices and edges of g2o are read, the information as a full symmetric matrix") {
  const PoseGraph graph = read(kVertices + kEdge);
  REQUIRE(graph.nodes.size() == 2);
  CHECK(graph.nodes[0].T_world_node.t == Vec3(1, 2, 3));
  CHECK(graph.nodes[1].T_world_node.q.z() == 1.0);
  CHECK(graph.nodes[1].T_world_node.s == 1.0);
  REQUIRE(graph.edges.size() == 1);
  CHECK(graph.edges[0].kind == FileEdgeKind::kRigid);
  CHECK(graph.edges[0].P.t == Vec3(1, 0, 0));
  REQUIRE(graph.information.size() == 1);
  const Mat6& information = graph.information[0];
  CHECK(information(0, 1) == 0.5);
  CHECK(information(1, 0) == 0.5);
  CHECK(information(5, 5) == 15.0);
}

TEST_CASE("the first vertex is held unless the file says which") {
  const PoseGraph first = read(kVertices + kEdge);
  CHECK(first.nodes[0].fixed);
  CHECK_FALSE(first.nodes[1].fixed);
  const PoseGraph second = read(kVertices + "FIX 9\n" + kEdge);
  CHECK_FALSE(second.nodes[0].fixed);
  CHECK(second.nodes[1].fixed);
}

TEST_CASE("what a g2o file may not hold is named with its line") {
  CHECK_THROWS_WITH(read("VERTEX_SE2 0 0 0 0\n"), Catch::Contains(":1: 'VERTEX_SE2'"));
  CHECK_THROWS_WITH(read(kVertices + "EDGE_SE3:QUAT 5 8 1 0 0 0 0 0 1\n"),
                    Catch::Contains(":3: node 8"));
  CHECK_THROWS_WITH(read(kVertices + "EDGE_SE3:QUAT 5 9 1 0 0 0 0 0 1 1 0 0\n"),
                    Catch::Contains(":3: the record ends too early"));
  CHECK_THROWS_WITH(read(kVertices + "EDGE_SE3:QUAT 5 9 1 0 0 0 0 0 1 "
                                     "1 2 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n"),
                    Catch::Contains("not positive definite"));
}
