// SPDX-License-Identifier: MIT
// Graph: ids, capacities, edits, refusals.
#include "core/graph/graph.hpp"

#include <limits>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::about_z;
using unisim_test::CarvedGraph;
using unisim_test::kNan;

namespace {

int32_t node(Graph& graph, double x) {
  int32_t id = -1;
  REQUIRE(graph.add_node(NodeKind::kKeyframe, about_z(0, x, 0, 0, 1), &id) == Status::kOk);
  return id;
}

}  // namespace

TEST_CASE("nodes and edges count up to their capacities") {
  CarvedGraph graph({2, 2, 1});
  REQUIRE(graph.fits());
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 1);
  int32_t id = -1;
  CHECK(graph->add_node(NodeKind::kSubmap, Sim3(), &id) == Status::kCapacity);
  CHECK(graph->add_tie(a, b, Sim3(), Sim3(), {}, &id) ==
        Status::kCapacity);  // needs 2 measurements
  CHECK(graph->add_two_view(a, b, Sim3(), {}, &id) == Status::kOk);
  CHECK(graph->add_bridge(a, b, Sim3(), {}, &id) == Status::kCapacity);
  CHECK(graph->add_scale(a, b, 0.0, {}, &id) == Status::kOk);
  CHECK(graph->add_scale(a, b, 0.0, {}, &id) == Status::kCapacity);
  CHECK(graph->node_count() == 2);
  CHECK(graph->edge_count() == 2);
}

TEST_CASE("removed ids and measurements are used again") {
  CarvedGraph graph({3, 2, 2});
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 1);
  const int32_t c = node(*graph, 2);
  int32_t tie = -1;
  int32_t id = -1;
  REQUIRE(graph->add_tie(a, b, Sim3(), Sim3(), {}, &tie) == Status::kOk);
  REQUIRE(graph->remove_edge(tie) == Status::kOk);
  CHECK_FALSE(graph->has_edge(tie));
  CHECK(graph->add_two_view(a, b, Sim3(), {}, &id) == Status::kOk);
  CHECK(graph->add_two_view(b, c, Sim3(), {}, &id) == Status::kOk);
  REQUIRE(graph->remove_node(b) == Status::kOk);
  CHECK(graph->edge_count() == 0);
  CHECK(graph->node_count() == 2);
  CHECK_FALSE(graph->has_node(b));
  CHECK(node(*graph, 5) == b);
  CHECK(graph->add_tie(a, b, Sim3(), Sim3(), {}, &id) == Status::kOk);
}

TEST_CASE("bad input is refused and changes nothing") {
  CarvedGraph graph({2, 4, 4});
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 1);
  int32_t id = 77;
  Sim3 bad;
  bad.s = 0.0;
  EdgeWeight negative;
  negative.information = -1.0;
  EdgeWeight not_a_number;
  not_a_number.multiplier = kNan;
  EdgeWeight flat;
  flat.kernel = {RobustKernelKind::kHuber, 0.0};
  const uint64_t revision = graph->revision();
  CHECK(graph->add_node(NodeKind::kKeyframe, bad, &id) == Status::kInvalidArgument);
  CHECK(graph->add_two_view(a, a, Sim3(), {}, &id) == Status::kInvalidArgument);
  CHECK(graph->add_two_view(a, 9, Sim3(), {}, &id) == Status::kInvalidArgument);
  CHECK(graph->add_two_view(-1, b, Sim3(), {}, &id) == Status::kInvalidArgument);
  CHECK(graph->add_bridge(a, b, bad, {}, &id) == Status::kInvalidArgument);
  CHECK(graph->add_tie(a, b, Sim3(), bad, {}, &id) == Status::kInvalidArgument);
  CHECK(graph->add_scale(a, b, kNan, {}, &id) == Status::kInvalidArgument);
  CHECK(graph->add_scale(a, b, 0.0, negative, &id) == Status::kInvalidArgument);
  CHECK(graph->add_scale(a, b, 0.0, not_a_number, &id) == Status::kInvalidArgument);
  CHECK(graph->add_scale(a, b, 0.0, flat, &id) == Status::kInvalidArgument);
  CHECK(graph->set_pose(a, bad) == Status::kInvalidArgument);
  CHECK(graph->set_fixed(9, true) == Status::kInvalidArgument);
  CHECK(graph->remove_edge(0) == Status::kInvalidArgument);
  CHECK(graph->remove_node(2) == Status::kInvalidArgument);
  CHECK(id == 77);
  CHECK(graph->revision() == revision);
  CHECK(graph->edge_count() == 0);
}

TEST_CASE("a measurement can be replaced only by one of its kind") {
  CarvedGraph graph({2, 3, 3});
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 1);
  int32_t pose = -1;
  int32_t tie = -1;
  int32_t scale = -1;
  REQUIRE(graph->add_two_view(a, b, Sim3(), {}, &pose) == Status::kOk);
  REQUIRE(graph->add_tie(a, b, Sim3(), Sim3(), {}, &tie) == Status::kOk);
  REQUIRE(graph->add_scale(a, b, 0.5, {}, &scale) == Status::kOk);
  CHECK(graph->edge_norm(pose) == Approx(1.0));
  CHECK(graph->set_measurement(pose, about_z(0, 1, 0, 0, 1)) == Status::kOk);
  CHECK(graph->edge_norm(pose) == Approx(0.0).margin(1e-15));
  CHECK(graph->set_tie_measurement(tie, about_z(0, 1, 0, 0, 1), Sim3()) == Status::kOk);
  CHECK(graph->edge_norm(tie) == Approx(0.0).margin(1e-15));
  CHECK(graph->set_log_ratio(scale, 0.0) == Status::kOk);
  CHECK(graph->edge_norm(scale) == Approx(0.0).margin(1e-15));
  CHECK(graph->set_measurement(tie, Sim3()) == Status::kInvalidArgument);
  CHECK(graph->set_measurement(scale, Sim3()) == Status::kInvalidArgument);
  CHECK(graph->set_tie_measurement(pose, Sim3(), Sim3()) == Status::kInvalidArgument);
  CHECK(graph->set_log_ratio(pose, 0.0) == Status::kInvalidArgument);
}

TEST_CASE("cost is the robust cost of the whitened norm, and suspended edges do not count") {
  CarvedGraph graph({2, 2, 1});
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 3);
  EdgeWeight weight;
  weight.information = 2.0;
  weight.multiplier = 2.0;
  weight.kernel = {RobustKernelKind::kHuber, 1.0};
  int32_t id = -1;
  REQUIRE(graph->add_two_view(a, b, Sim3(), weight, &id) == Status::kOk);
  CHECK(graph->edge_norm(id) == Approx(6.0));  // sqrt(4) * 3
  CHECK(graph->cost() == Approx(5.5));         // 1 * (6 - 1/2)
  REQUIRE(graph->set_multiplier(id, 0.0) == Status::kOk);
  CHECK(graph->cost() == 0.0);
  REQUIRE(graph->set_multiplier(id, 2.0) == Status::kOk);
  REQUIRE(graph->set_suspended(id, true) == Status::kOk);
  CHECK(graph->cost() == 0.0);
  CHECK(graph->edge_norm(id) == Approx(6.0));
  CHECK(graph->has_edge(id));
}

TEST_CASE("what has changed at a node is told to whoever remembers a revision") {
  CarvedGraph graph({2, 2, 1});
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 1);
  const uint64_t added = graph->revision();
  CHECK(graph->changes_since(a, added) == 0);
  CHECK(graph->changes_since(a, added - 2) == (unisim::kNodeMoved | unisim::kNodeRelinked));
  REQUIRE(graph->set_pose(a, Sim3()) == Status::kOk);
  const uint64_t moved = graph->revision();
  REQUIRE(graph->set_fixed(b, true) == Status::kOk);
  CHECK(graph->changes_since(a, added) == unisim::kNodeMoved);
  CHECK(graph->changes_since(a, moved) == 0);
  CHECK(graph->changes_since(b, moved) == (unisim::kNodeHeld | unisim::kNodeRelinked));
}

TEST_CASE("suspending an edge changes which are active, not the structure") {
  CarvedGraph graph({2, 2, 1});
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 1);
  int32_t edge = -1;
  REQUIRE(graph->add_two_view(a, b, Sim3(), {}, &edge) == Status::kOk);
  const uint64_t structure = graph->structure_revision();
  const uint64_t active = graph->activity_revision();
  REQUIRE(graph->set_suspended(edge, true) == Status::kOk);
  CHECK(graph->structure_revision() == structure);
  CHECK(graph->activity_revision() == active + 1);
  REQUIRE(graph->set_suspended(edge, true) == Status::kOk);
  CHECK(graph->activity_revision() == active + 1);
}

TEST_CASE("only changes of structure raise the structure revision") {
  CarvedGraph graph({2, 1, 1});
  const int32_t a = node(*graph, 0);
  const int32_t b = node(*graph, 1);
  int32_t id = -1;
  REQUIRE(graph->add_two_view(a, b, Sim3(), {}, &id) == Status::kOk);
  const uint64_t structure = graph->structure_revision();
  const uint64_t values = graph->revision();
  REQUIRE(graph->set_pose(b, Sim3()) == Status::kOk);
  REQUIRE(graph->set_suspended(id, true) == Status::kOk);
  REQUIRE(graph->set_fixed(a, false) == Status::kOk);  // as it was
  CHECK(graph->structure_revision() == structure);
  CHECK(graph->revision() > values);
  REQUIRE(graph->set_fixed(a, true) == Status::kOk);
  CHECK(graph->structure_revision() > structure);
}

TEST_CASE("clear empties a graph for the next use") {
  CarvedGraph graph({1, 1, 1});
  node(*graph, 0);
  graph->clear();
  CHECK(graph->node_count() == 0);
  CHECK(node(*graph, 0) == 0);
}
