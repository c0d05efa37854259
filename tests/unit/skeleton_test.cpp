// SPDX-License-Identifier: MIT
// The skeleton on its own: windows retire, merge and are forgotten; loops become edges.
#include "core/skeleton/skeleton.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"
#include "tests/unit/map_walk.hpp"

using namespace unisim;
using unisim_test::difference;
using unisim_test::MapWalk;

TEST_CASE("the oldest window becomes a node of the skeleton with its keyframes rigid under it") {
  MapWalk walk;
  const int32_t first = walk.walk_on();
  const int32_t second = walk.walk_on();
  CHECK(walk.skeleton.nodes().empty());
  walk.walk_on();
  REQUIRE(walk.skeleton.nodes().size() == 1);
  CHECK(walk.skeleton.nodes()[0].submap == first);
  CHECK(walk.skeleton.windows().size() == 2);
  CHECK(walk.skeleton.live_from() == walk.map.submaps[second].window.first);
  CHECK(walk.skeleton.counts().windows == 1);
  CHECK(walk.skeleton.counts().keyframes == walk.skeleton.live_from());
  for (int32_t id = 0; id < walk.map.keyframes.size(); ++id) {
    CHECK(walk.map.keyframes[id].retired() == (id < walk.skeleton.live_from()));
    CHECK(difference(walk.map.keyframe_pose(id), MapWalk::pose_at(id)) < 1e-12);
  }
}

TEST_CASE("what lay between two windows becomes one edge that says where they are") {
  MapWalk walk;
  for (int32_t k = 0; k < 3; ++k) walk.walk_on();
  REQUIRE(walk.chain_edges(EdgeOrigin::kWindow) == 1);
  for (int32_t id = 0; id < walk.map.graph.edge_end(); ++id) {
    if (!walk.map.graph.has_edge(id)) continue;
    const Edge& edge = walk.map.graph.edge(id);
    if (edge.kind != FactorKind::kChain) continue;
    const Sim3 expected = between(walk.map.graph.pose(edge.a), walk.map.graph.pose(edge.b));
    CHECK(difference(walk.map.graph.link(edge).Z_a_b, expected) < 1e-9);
    CHECK(valid_link(walk.map.graph.link(edge)));
  }
}

TEST_CASE("a retired keyframe follows the node that carries it") {
  MapWalk walk;
  const int32_t first = walk.walk_on();
  for (int32_t k = 0; k < 2; ++k) walk.walk_on();
  Sim3 moved;
  moved.t = {1.0, 2.0, 3.0};
  const int32_t node = walk.map.submaps[first].place.node;
  REQUIRE(walk.map.graph.set_pose(node, moved * walk.map.graph.pose(node)) == Status::kOk);
  CHECK(difference(walk.map.keyframe_pose(0), moved * MapWalk::pose_at(0)) < 1e-12);
}

TEST_CASE("beyond its capacity neighbours merge, and no window or pose is lost") {
  MapWalk walk;
  for (int32_t k = 0; k < 12; ++k) walk.walk_on();
  REQUIRE(walk.skeleton.nodes().size() == 4);
  int32_t windows = 0;
  for (const SkeletonNode& node : walk.skeleton.nodes()) windows += node.windows;
  CHECK(windows == walk.skeleton.counts().windows);
  CHECK(walk.chain_edges(EdgeOrigin::kWindow) == 4);
  for (int32_t id = walk.map.keyframes.first(); id < walk.map.keyframes.size(); ++id) {
    CHECK(difference(walk.map.keyframe_pose(id), MapWalk::pose_at(id)) < 1e-9);
  }
}

TEST_CASE("each retired keyframe and each merge is offered once") {
  MapWalk walk;
  int32_t next = 0;
  int32_t merges = 0;
  Retired retired;
  for (int32_t k = 0; k < 12; ++k) {
    walk.walk_on();
    while (walk.skeleton.next_retired(&retired) == Status::kOk) {
      if (retired.keyframe >= 0) {
        CHECK(retired.keyframe == next++);
      } else {
        CHECK(retired.anchor >= 0);
        ++merges;
      }
    }
  }
  CHECK(next == walk.skeleton.live_from());
  CHECK(merges == walk.skeleton.counts().windows - walk.skeleton.nodes().size());
  CHECK(walk.skeleton.unread() == 0);
}

TEST_CASE("keyframes that no window comes for leave under a submap of their own") {
  MapWalk walk;
  walk.walk_on();
  walk.add_keyframes(6);
  const int32_t before = walk.map.submaps.size();
  REQUIRE(walk.skeleton.close_stretch());
  CHECK(walk.map.submaps.size() == before + 1);
  CHECK(walk.skeleton.counts().stretches == 1);
  REQUIRE(walk.skeleton.close_stretch());
  CHECK_FALSE(walk.skeleton.close_stretch());
}

TEST_CASE("keyframes that are about to be forgotten retire first, all but the newest if need be") {
  MapWalk walk;
  walk.add_keyframes(12);
  walk.skeleton.let_go_through(5);
  CHECK_FALSE(walk.map.broken());
  CHECK(walk.skeleton.counts().stretches == 3);
  CHECK(walk.skeleton.counts().keyframes == 11);
  CHECK(walk.skeleton.live_from() == 11);
  CHECK(walk.skeleton.windows().empty());
  CHECK(walk.skeleton.unread() == 6);
  CHECK(walk.map.keyframes[5].retired());
}

TEST_CASE("parts of a map that nothing joins are forgotten oldest first") {
  MapWalk walk;
  for (int32_t k = 0; k < 10; ++k) {
    walk.segment = k;
    walk.add_keyframes(4);
    walk.add_window();
  }
  CHECK_FALSE(walk.map.broken());
  CHECK(walk.skeleton.nodes().size() == 4);
  CHECK(walk.map.keyframes.first() > 0);
  CHECK(walk.chain_edges(EdgeOrigin::kWindow) == 0);
}

TEST_CASE("a loop that ends in a part that is forgotten goes with it") {
  MapWalk walk;
  for (int32_t k = 0; k < 4; ++k) {
    walk.segment = k;
    walk.add_keyframes(4);
    walk.add_window();
    if (k == 1) walk.add_loop(0, 4);
  }
  REQUIRE_FALSE(walk.skeleton.loop_edges().empty());
  for (int32_t k = 4; k < 10; ++k) {
    walk.segment = k;
    walk.add_keyframes(4);
    walk.add_window();
  }
  CHECK(walk.skeleton.loop_edges().empty());
  CHECK(walk.skeleton.loop_edges().dropped_loops() == 1);
  CHECK_FALSE(walk.map.broken());
}

TEST_CASE("a loop whose keyframes have retired becomes one edge between two nodes") {
  MapWalk walk;
  for (int32_t k = 0; k < 3; ++k) walk.walk_on();
  const int32_t loop = walk.add_loop(0, 4);
  LoopStatus status;
  REQUIRE(walk.skeleton.loop_status(loop, &status) == Status::kOk);
  CHECK_FALSE(status.condensed);
  for (int32_t k = 0; k < 2; ++k) walk.walk_on();
  REQUIRE(walk.skeleton.loop_status(loop, &status) == Status::kOk);
  CHECK(status.condensed);
  CHECK(status.state == LoopState::kActive);
  CHECK(walk.skeleton.loops().empty());
  CHECK(walk.chain_edges(EdgeOrigin::kLoop) == 1);
}

TEST_CASE("loops between the same nodes that agree share an edge, those that do not are rivals") {
  MapWalk walk;
  for (int32_t k = 0; k < 3; ++k) walk.walk_on();
  const int32_t one = walk.add_loop(0, 4);
  const int32_t same = walk.add_loop(0, 4);
  Sim3 miss;
  miss.t = {5.0, 0.0, 0.0};
  const int32_t rival = walk.add_loop(0, 4, miss);
  for (int32_t k = 0; k < 2; ++k) walk.walk_on();
  CHECK(walk.chain_edges(EdgeOrigin::kLoop) == 2);
  CHECK(walk.map.submaps[one].loop_edge == walk.map.submaps[same].loop_edge);
  CHECK(walk.map.submaps[one].loop_edge != walk.map.submaps[rival].loop_edge);
}

TEST_CASE("a loop the host takes back leaves nothing in the graph") {
  MapWalk walk;
  for (int32_t k = 0; k < 3; ++k) walk.walk_on();
  const int32_t edges = walk.map.graph.edge_count();
  const int32_t live = walk.add_loop(0, 7);
  REQUIRE(walk.skeleton.remove_loop(live) == Status::kOk);
  CHECK(walk.map.graph.edge_count() == edges);
  CHECK(walk.skeleton.remove_loop(live) == Status::kInvalidArgument);
  const int32_t condensed = walk.add_loop(0, 4);
  for (int32_t k = 0; k < 2; ++k) walk.walk_on();
  REQUIRE(walk.chain_edges(EdgeOrigin::kLoop) == 1);
  REQUIRE(walk.skeleton.remove_loop(condensed) == Status::kOk);
  CHECK(walk.chain_edges(EdgeOrigin::kLoop) == 0);
  CHECK(walk.skeleton.counts().loops_removed == 2);
}
