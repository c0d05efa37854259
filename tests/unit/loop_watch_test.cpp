// SPDX-License-Identifier: MIT
// The watch over loops on its own.
#include "core/skeleton/loop_watch.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"
#include "tests/unit/map_walk.hpp"

using namespace unisim;
using unisim_test::difference;
using unisim_test::MapWalk;

namespace {

constexpr int32_t kPatience = 5;    // optimisations beyond the gate until a loop is suspended
constexpr int32_t kFirstWait = 10;  // optimisations until it is looked at again

Sim3 shifted(double x) {
  Sim3 T;
  T.t = {x, 0.0, 0.0};
  return T;
}

/// Two nodes and a condensed loop between them that says they are at the same place.
struct WatchFixture {
  WatchFixture() {
    MapWalk::require(walk.map.graph.add_node(NodeKind::kSkeleton, Sim3(), &a));
    MapWalk::require(walk.map.graph.add_node(NodeKind::kSkeleton, shifted(1.0), &b));
    const ChainLink link = {Sim3(), Mat7::Identity()};
    const RobustKernel kernel = walk.map.config.kernel(EdgeOrigin::kLoop);
    MapWalk::require(
        walk.map.graph.add_chain(a, b, link, {1.0, 1.0, kernel, EdgeOrigin::kLoop}, &loop.edge));
    loop.loop = 7;
    loop.loops = 1;
  }
  /// Where b lies in the map: the loop's residual is its distance from a.
  void put_b(double x) { MapWalk::require(walk.map.graph.set_pose(b, shifted(x))); }
  void look(int32_t times) {
    for (int32_t k = 0; k < times; ++k) walk.watch.look_at(&loop, ++now);
  }
  bool edge_suspended() const { return walk.map.graph.edge(loop.edge).suspended; }

  MapWalk walk;
  LoopEdge loop;
  int32_t a = -1;
  int32_t b = -1;
  int64_t now = 0;
};

}  // namespace

TEST_CASE("a loop is suspended when it misses the map time after time") {
  WatchFixture f;
  f.look(kPatience - 1);
  CHECK_FALSE(f.loop.health.suspended);
  CHECK(f.loop.health.norm == Approx(1.0));
  f.walk.watch.news_solved();
  f.look(1);
  CHECK(f.loop.health.suspended);
  CHECK(f.edge_suspended());
  CHECK(f.walk.watch.suspended() == 1);
  CHECK(f.walk.watch.suspensions() == 1);
  CHECK(f.walk.watch.has_news());
}

TEST_CASE("a loop that agrees in between starts anew") {
  WatchFixture f;
  f.look(kPatience - 1);
  f.put_b(0.0);
  f.look(1);
  f.put_b(1.0);
  f.look(kPatience - 1);
  CHECK_FALSE(f.loop.health.suspended);
  CHECK_FALSE(f.edge_suspended());
}

TEST_CASE("a suspended loop is tried when its time has come, and comes back where it agrees") {
  WatchFixture f;
  f.look(kPatience);
  f.put_b(0.0);
  f.look(kFirstWait - 1);
  CHECK(f.loop.health.suspended);
  f.walk.watch.news_solved();
  f.look(1);
  CHECK_FALSE(f.loop.health.suspended);
  CHECK_FALSE(f.edge_suspended());
  CHECK(f.walk.watch.suspended() == 0);
  CHECK(f.walk.watch.returns() == 1);
  CHECK(f.walk.watch.has_news());
}

TEST_CASE("the wait of a loop that goes on missing the map doubles up to a limit") {
  WatchFixture f;
  f.look(kPatience);
  int32_t wait = kFirstWait;
  for (int32_t k = 0; k < 9; ++k) {
    CHECK(f.loop.health.wait == wait);
    f.look(f.loop.health.wait);
    wait = std::min(2 * wait, 640);
  }
  CHECK(f.loop.health.suspended);
  CHECK(f.walk.watch.suspensions() == 1);
}

TEST_CASE("a loop with views is judged by the place that it misses") {
  MapWalk walk;
  for (int32_t k = 0; k < 2; ++k) walk.walk_on();
  Submap& loop = walk.map.submaps[walk.add_loop(0, 5, shifted(2.0))];
  // It sits on the first place, or on the second.
  const double x = GENERATE(0.0, -2.0);
  MapWalk::require(walk.map.graph.set_pose(loop.place.node, shifted(x)));
  walk.watch.look_at(&loop, 1);
  CHECK(loop.health.norm == Approx(2.0).epsilon(0.01));
  for (int64_t now = 2; now <= kPatience; ++now) walk.watch.look_at(&loop, now);
  CHECK(loop.health.suspended);
  for (int32_t k = 0; k < loop.count; ++k) {
    CHECK(walk.map.graph.edge(walk.map.submaps.view(loop, k).bridge).suspended);
    CHECK(walk.map.graph.edge(walk.map.submaps.view(loop, k).anchor).suspended);
  }
}

TEST_CASE("a suspended loop is put on its origin again before it is tried") {
  MapWalk walk;
  for (int32_t k = 0; k < 2; ++k) walk.walk_on();
  Submap& loop = walk.map.submaps[walk.add_loop(0, 5)];
  MapWalk::require(walk.map.graph.set_pose(loop.place.node, shifted(9.0)));
  for (int64_t now = 1; now <= kPatience; ++now) walk.watch.look_at(&loop, now);
  REQUIRE(loop.health.suspended);
  walk.watch.look_at(&loop, loop.health.retry_at);
  CHECK_FALSE(loop.health.suspended);
  CHECK(difference(walk.map.graph.pose(loop.place.node), MapWalk::pose_at(0)) < 1e-12);
}

TEST_CASE("a loop the host has removed is not looked at") {
  MapWalk walk;
  for (int32_t k = 0; k < 2; ++k) walk.walk_on();
  const int32_t id = walk.add_loop(0, 5, shifted(2.0));
  REQUIRE(walk.skeleton.remove_loop(id) == Status::kOk);
  for (int64_t now = 1; now <= 2 * kPatience; ++now) walk.skeleton.watch_loops(now);
  CHECK_FALSE(walk.map.submaps[id].health.suspended);
  CHECK(walk.watch.suspensions() == 0);
}
