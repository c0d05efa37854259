// SPDX-License-Identifier: MIT
// Condensed loops: fused, moved to another edge, dropped.
#include "core/skeleton/loop_edges.hpp"

#include <numeric>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/unit/map_walk.hpp"

using namespace unisim;
using unisim_test::MapWalk;

namespace {

/// Four nodes in a row and three places for loops between them.
struct LoopFixture {
  LoopFixture()
      : memory(4096), arena(memory.data(), memory.size()), edges(arena, 3, walk.map, watch) {
    for (int32_t k = 0; k < 4; ++k) {
      int32_t node = -1;
      MapWalk::require(
          walk.map.graph.add_node(NodeKind::kSkeleton, MapWalk::pose_at(10 * k), &node));
      nodes.push_back(node);
    }
    order.resize(64);
    for (int32_t k = 0; k < 4; ++k) order[at(k)] = 10 * k;
  }
  size_t at(int32_t k) const { return static_cast<size_t>(nodes[static_cast<size_t>(k)]); }
  int32_t node(int32_t k) const { return nodes[static_cast<size_t>(k)]; }
  /// Measurement of the node at `b` from that at `a`, off by `miss`.
  static ChainLink link(int32_t a, int32_t b, double information, double miss = 0.0) {
    ChainLink link;
    link.Z_a_b = MapWalk::pose_at(10 * (b - a));
    link.Z_a_b.t[0] += miss;
    link.Lambda = Mat7::Identity() * information;
    return link;
  }
  /// Like the skeleton does it. @return id of the loop's submap
  int32_t add(int32_t a, int32_t b, const ChainLink& said, bool suspended = false) {
    const int32_t id = walk.map.submaps.append(true, 1);
    Submap& loop = walk.map.submaps[id];
    walk.map.submaps.release_views(&loop);
    loop.health.suspended = suspended;
    if (!edges.join(node(a), node(b), said, &loop)) edges.add(node(a), node(b), said, &loop);
    return id;
  }
  int32_t weakest() { return edges.weakest({order.data(), static_cast<int32_t>(order.size())}); }
  const Submap& loop(int32_t id) { return walk.map.submaps[id]; }

  MapWalk walk;
  LoopWatch watch{walk.map};
  std::vector<unsigned char> memory;
  Arena arena;
  LoopEdges edges;
  std::vector<int32_t> nodes;
  std::vector<int32_t> order;
};

}  // namespace

TEST_CASE("a loop that says the same joins the edge and adds its information") {
  LoopFixture f;
  const int32_t one = f.add(0, 1, LoopFixture::link(0, 1, 2.0));
  const int32_t two = f.add(0, 1, LoopFixture::link(0, 1, 3.0));
  CHECK(f.loop(one).loop_edge == f.loop(two).loop_edge);
  const LoopEdge& edge = f.edges[f.loop(one).loop_edge];
  CHECK(edge.loops == 2);
  CHECK(edge.loop == two);
  CHECK(f.walk.map.graph.link(f.walk.map.graph.edge(edge.edge)).Lambda(0, 0) == Approx(5.0));
}

TEST_CASE("a loop that says something else, or is suspended, has an edge of its own") {
  LoopFixture f;
  const int32_t one = f.add(0, 1, LoopFixture::link(0, 1, 2.0));
  CHECK(f.loop(f.add(0, 1, LoopFixture::link(0, 1, 2.0, 4.0))).loop_edge != f.loop(one).loop_edge);
  CHECK(f.loop(f.add(0, 1, LoopFixture::link(0, 1, 2.0), true)).loop_edge != f.loop(one).loop_edge);
  CHECK(f.watch.suspended() == 1);
  CHECK(f.edges.full());
}

TEST_CASE("the weakest is the less sure of the two that join most nearly the same places") {
  LoopFixture f;
  CHECK(f.weakest() == -1);
  CHECK(f.edges.empty());
  f.order[f.at(1)] = 1;  // nearer to node 0 than the others are to each other
  f.add(0, 3, LoopFixture::link(0, 3, 5.0));
  const int32_t unsure = f.add(1, 3, LoopFixture::link(1, 3, 1.0));
  f.add(0, 2, LoopFixture::link(0, 2, 0.1));
  CHECK(f.weakest() == f.loop(unsure).loop_edge);
}

TEST_CASE("a suspended loop is the first to go") {
  LoopFixture f;
  f.add(0, 3, LoopFixture::link(0, 3, 1.0));
  f.add(1, 3, LoopFixture::link(1, 3, 1.0));
  const int32_t suspended = f.add(0, 2, LoopFixture::link(0, 2, 9.0), true);
  REQUIRE(f.weakest() == f.loop(suspended).loop_edge);
  f.edges.drop(f.weakest());
  CHECK(f.loop(suspended).removed);
  CHECK(f.loop(suspended).loop_edge == -1);
  CHECK(f.edges.dropped_loops() == 1);
  CHECK(f.watch.suspended() == 0);
  CHECK_FALSE(f.edges.full());
}

TEST_CASE("edges that have come to join the same nodes are fused") {
  LoopFixture f;
  const int32_t one = f.add(0, 2, LoopFixture::link(0, 2, 1.0));
  const int32_t two = f.add(1, 2, LoopFixture::link(0, 2, 1.0));
  LoopEdge& moved = f.edges[f.loop(two).loop_edge];
  moved.edge =
      replace_chain(f.walk.map, moved.edge, f.node(0), f.node(2), LoopFixture::link(0, 2, 1.0));
  f.edges.fuse_at(f.node(0));
  CHECK(f.loop(one).loop_edge == f.loop(two).loop_edge);
  CHECK(f.edges[f.loop(one).loop_edge].loops == 2);
  CHECK(f.walk.chain_edges(EdgeOrigin::kLoop) == 1);
}

TEST_CASE("what ends at a node that goes is dropped") {
  LoopFixture f;
  const int32_t there = f.add(0, 3, LoopFixture::link(0, 3, 1.0));
  const int32_t elsewhere = f.add(1, 2, LoopFixture::link(1, 2, 1.0));
  f.edges.drop_at(f.node(3));
  CHECK(f.loop(there).removed);
  CHECK_FALSE(f.loop(elsewhere).removed);
}
