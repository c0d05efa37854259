// SPDX-License-Identifier: MIT
// Which edges keep their linearisation when their ends move.
#include "core/solve/linearize/linearization_points.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::Random;

namespace {

constexpr double kTolerance = 1e-2;
using CarvedPoints = unisim_test::Carved<LinearizationPoints, int32_t>;

// Two nodes and an edge between them, linearised where they are.
struct Linearized {
  explicit Linearized(RobustKernel kernel = {}) : graph(kCapacity), points(1) {
    Random random(5);
    REQUIRE(is_ok(graph->add_node(NodeKind::kKeyframe, random.pose(3.0, 3.0, 0.5), &a)));
    REQUIRE(is_ok(graph->add_node(NodeKind::kKeyframe, random.pose(3.0, 3.0, 0.5), &b)));
    const Sim3 Z = between(graph->pose(a), graph->pose(b)) * sim3_exp(Vec7::Constant(0.01));
    REQUIRE(is_ok(graph->add_two_view(a, b, Z, {1.0, 1.0, kernel}, &edge)));
    points->set(*graph, edge);
    points->set_cost(*graph, edge, graph->cost());
  }
  void move(int32_t node, const Sim3& T) { REQUIRE(is_ok(graph->set_pose(node, T))); }
  bool follows(double tolerance = kTolerance) {
    return points->follows(*graph, edge, graph->cost(), tolerance);
  }

  static constexpr GraphCapacity kCapacity = {2, 1, 1, 0};
  unisim_test::Carved<Graph, GraphCapacity> graph;
  CarvedPoints points;
  int32_t a = -1;
  int32_t b = -1;
  int32_t edge = -1;
};

}  // namespace

TEST_CASE("an edge whose ends move together keeps its linearisation however far they go") {
  Linearized one;
  Vec7 far;
  far << 50.0, -20.0, 30.0, 2.0, -1.0, 0.5, 1.0;
  const Sim3 T = sim3_exp(far);
  one.move(one.a, T * one.graph->pose(one.a));
  one.move(one.b, T * one.graph->pose(one.b));
  CHECK(one.follows());
  CHECK(!one.points->is_here(one.edge));
}

TEST_CASE("an edge that has changed beyond the tolerance in any direction is linearised anew") {
  for (int k = 0; k < 7; ++k) {
    for (const double sign : {-1.0, 1.0}) {
      CAPTURE(k, sign);
      Linearized small;
      Linearized large;
      const double length = k < 3 ? std::max(1.0, small.points->relative_pose(0).t.norm()) : 1.0;
      Vec7 dx = Vec7::Zero();
      dx[k] = 0.3 * sign * kTolerance;
      small.move(small.b, retract(small.graph->pose(small.b), dx));
      CHECK(small.follows());
      dx[k] = 4.0 * sign * kTolerance * length;
      large.move(large.b, retract(large.graph->pose(large.b), dx));
      CHECK(!large.follows());
    }
  }
}

TEST_CASE("an edge whose robust weight has changed is linearised anew") {
  Linearized one({RobustKernelKind::kGemanMcClure, 0.01});
  Vec7 dx = Vec7::Zero();
  dx[0] = 0.01;
  one.move(one.b, retract(one.graph->pose(one.b), dx));
  CHECK(!one.follows(1.0));
}

TEST_CASE("an edge that was forgotten follows nothing") {
  Linearized one;
  one.points->forget(one.edge);
  CHECK(!one.points->knows(one.edge));
  CHECK(!one.follows());
}
