// SPDX-License-Identifier: MIT
// Reader of .usg graphs: every record, and what is said about a broken one.
#include "drivers/sequence/text_file.hpp"
#include "tests/bench/graph_of.hpp"
#include "tests/support/catch.hpp"

using namespace unisim;
using namespace unisim::bench;

namespace {

constexpr const char* kGraph =
    "# usg 1\n"
    "node 0 T 1 0 0 0 1 0 0 0 1\n"
    "node 1 T 0 0 0 0 2 1 2 3 0.5\n"
    "edge v2v 0 1 2 0.1 0 0 0 1 4 5 6 1.5\n"
    "node 1000000 S 0 0 0 0 1 0 0 0 1\n"
    "edge bridge 1000000 1 1 0 0 0 0 1 0 0 0 1\n"
    "edge anchor 1000000 1 50 0 -0.25\n"
    "node 1000001 S 0 0 0 0 1 0 0 0 1\n"
    "edge tie 1000000 1000001 0.2 0 0 0 0 1 1 0 0 1 0 0 0 1 2 0 0 1\n"
    "edge scale 1000000 1000001 50 0.3 0.125\n";

void require_refusal(const std::string& content, const std::string& place,
                     const std::string& reason) {
  INFO(content);
  try {
    graph_of(content);
    FAIL("the file was taken");
  } catch (const sequence::InputError& error) {
    const std::string line = error.what();
    INFO(line);
    CHECK(line.find(place) != std::string::npos);
    CHECK(line.find(reason) != std::string::npos);
    CHECK(line.find('\n') == std::string::npos);
  }
}

const std::string kNodes = "node 0 T 1 0 0 0 1 0 0 0 1\nnode 1 T 0 0 0 0 1 0 0 0 1\n";

}  // namespace

TEST_CASE("nodes keep kind, hold and pose, and quaternions come out with length 1") {
  const PoseGraph graph = graph_of(kGraph);
  REQUIRE(graph.nodes.size() == 4);
  CHECK(graph.nodes[0].fixed);
  CHECK_FALSE(graph.nodes[0].submap);
  CHECK_FALSE(graph.nodes[1].fixed);
  CHECK(graph.nodes[1].T_world_node.q.w() == 1.0);
  CHECK(graph.nodes[1].T_world_node.t == Vec3(1, 2, 3));
  CHECK(graph.nodes[1].T_world_node.s == 0.5);
  CHECK(graph.nodes[2].submap);
}

TEST_CASE("edges keep type, ends, weight, width and measurement") {
  const PoseGraph graph = graph_of(kGraph);
  REQUIRE(graph.edges.size() == 5);
  CHECK(graph.edges[0].kind == FileEdgeKind::kTwoView);
  CHECK(graph.edges[0].weight == 2.0);
  CHECK(graph.edges[0].huber == 0.1);
  CHECK(graph.edges[0].P.t == Vec3(4, 5, 6));
  CHECK(graph.edges[0].P.s == 1.5);
  CHECK(graph.edges[1].kind == FileEdgeKind::kBridge);
  CHECK(graph.edges[1].a == 2);
  CHECK(graph.edges[1].b == 1);
  CHECK(graph.edges[2].kind == FileEdgeKind::kScaleAnchor);
  CHECK(graph.edges[2].log_ratio == -0.25);
  CHECK(graph.edges[3].kind == FileEdgeKind::kTie);
  CHECK(graph.edges[3].P.t.x() == 1.0);
  CHECK(graph.edges[3].Q.t.x() == 2.0);
  CHECK(graph.edges[4].kind == FileEdgeKind::kScale);
  CHECK(graph.edges[4].b == 3);
}

TEST_CASE("a broken record of a .usg file is named with its line") {
  require_refusal("vertex 0\n", ":1:", "node, edge or #");
  require_refusal("node 0 T 1 0 0 0 1 0 0 0\n", ":1:", "ends too early");
  require_refusal("node 0 T 1 0 0 0 1 0 0 0 1 7\n", ":1:", "more fields");
  require_refusal("node 0 X 1 0 0 0 1 0 0 0 1\n", ":1:", "kind");
  require_refusal("node 0 T 1 0 0 0 0 0 0 0 1\n", ":1:", "quaternion");
  require_refusal("node 0 T 1 0 0 0 1 0 nan 0 1\n", ":1:", "'nan'");
  require_refusal("node 0 T 1 0 0 0 1 0 0 0 -1\n", ":1:", "scale");
  require_refusal("node 0.5 T 1 0 0 0 1 0 0 0 1\n", ":1:", "not an integer");
  require_refusal(kNodes + "node 1 T 0 0 0 0 1 0 0 0 1\n", ":3:", "twice");
  require_refusal(kNodes + "edge v2v 0 7 1 0 0 0 0 1 0 0 0 1\n", ":3:", "node 7");
  require_refusal(kNodes + "edge v2v 1 1 1 0 0 0 0 1 0 0 0 1\n", ":3:", "itself");
  require_refusal(kNodes + "edge v2v 0 1 0 0 0 0 0 1 0 0 0 1\n", ":3:", "weight");
  require_refusal(kNodes + "edge hinge 0 1 1 0 0\n", ":3:", "'hinge'");
}

TEST_CASE("a graph without edges, a missing file and a foreign name are refused") {
  require_refusal(kNodes, "graph.usg", "no edges");
  CHECK_THROWS_AS(read_pose_graph("nowhere/graph.usg"), sequence::InputError);
  CHECK_THROWS_WITH(read_pose_graph("graph.txt"), Catch::Contains(".usg or .g2o"));
}
