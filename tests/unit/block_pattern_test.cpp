// SPDX-License-Identifier: MIT
// Block pattern: columns, slots, capacities.
#include "core/solve/order/block_pattern.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::CarvedGraph;
using CarvedPattern = unisim_test::Carved<BlockPattern, SolverCapacity>;

namespace {

// Nodes 0..4 in a chain by two-view edges, twice between 1 and 2, and 0 tied to 4.
void fill_ring(Graph& graph) {
  int32_t id = -1;
  for (int i = 0; i < 5; ++i) {
    REQUIRE(graph.add_node(NodeKind::kKeyframe, Sim3(), &id) == Status::kOk);
  }
  for (int i = 0; i < 4; ++i) {
    REQUIRE(graph.add_two_view(i, i + 1, Sim3(), {}, &id) == Status::kOk);
  }
  REQUIRE(graph.add_scale_anchor(2, 1, 0.0, {}, &id) == Status::kOk);
  REQUIRE(graph.add_tie(4, 0, Sim3(), Sim3(), {}, &id) == Status::kOk);
}

}  // namespace

TEST_CASE("every free node has a column and every pair a slot") {
  CarvedGraph graph({5, 6, 6});
  fill_ring(*graph);
  CarvedPattern pattern({5, 6, 5, 15});
  REQUIRE(pattern.fits());
  REQUIRE(pattern->build(*graph) == Status::kOk);
  CHECK(pattern->columns() == 5);
  CHECK(pattern->pairs() == 5);
  for (int32_t id = 0; id < 5; ++id) {
    CHECK(pattern->node_of_column(pattern->column_of_node(id)) == id);
  }
  for (int32_t id = 0; id < 6; ++id) {
    const EdgeSlot place = pattern->edge_slot(id);
    const int32_t a = pattern->column_of_node(graph->edge(id).a);
    const int32_t b = pattern->column_of_node(graph->edge(id).b);
    REQUIRE(place.slot >= 0);
    CHECK(place.a_is_later == (a > b));
    CHECK(pattern->rows()[place.slot] == std::max(a, b));
    CHECK(pattern->column_start()[std::min(a, b)] <= place.slot);
    CHECK(place.slot < pattern->column_start()[std::min(a, b) + 1]);
  }
  CHECK(pattern->edge_slot(1).slot == pattern->edge_slot(4).slot);  // both join 1 and 2
}

TEST_CASE("edges come by their first column, those between fixed nodes last") {
  CarvedGraph graph({5, 6, 6});
  fill_ring(*graph);
  REQUIRE(graph->set_fixed(1, true) == Status::kOk);
  REQUIRE(graph->set_fixed(2, true) == Status::kOk);  // edges 1 and 4 join 1 and 2
  CarvedPattern pattern({5, 6, 5, 15});
  REQUIRE(pattern->build(*graph) == Status::kOk);
  const auto first_column = [&](int32_t id) {
    const int32_t a = pattern->column_of_node(graph->edge(id).a);
    const int32_t b = pattern->column_of_node(graph->edge(id).b);
    return a < 0 || b < 0 ? std::max(a, b) : std::min(a, b);
  };
  const Span<const int32_t> edges = pattern->edges();
  REQUIRE(edges.size() == 6);
  for (int32_t i = 1; i < 4; ++i) CHECK(first_column(edges[i - 1]) <= first_column(edges[i]));
  CHECK(edges[4] == 1);
  CHECK(edges[5] == 4);
}

TEST_CASE("rows ascend within a column") {
  CarvedGraph graph({5, 6, 6});
  fill_ring(*graph);
  CarvedPattern pattern({5, 6, 5, 15});
  REQUIRE(pattern->build(*graph) == Status::kOk);
  for (int32_t j = 0; j < pattern->columns(); ++j) {
    for (int32_t p = pattern->column_start()[j]; p < pattern->column_start()[j + 1]; ++p) {
      CHECK(pattern->rows()[p] > j);
      if (p > pattern->column_start()[j]) CHECK(pattern->rows()[p] > pattern->rows()[p - 1]);
    }
  }
}

TEST_CASE("fixed nodes have no column and their edges no slot") {
  CarvedGraph graph({5, 6, 6});
  fill_ring(*graph);
  REQUIRE(graph->set_fixed(0, true) == Status::kOk);
  CarvedPattern pattern({5, 6, 5, 15});
  REQUIRE(pattern->build(*graph) == Status::kOk);
  CHECK(pattern->columns() == 4);
  CHECK(pattern->pairs() == 3);
  CHECK(pattern->column_of_node(0) == -1);
  CHECK(pattern->edge_slot(0).slot == -1);
  CHECK(pattern->edge_slot(5).slot == -1);
}

TEST_CASE("removed nodes and edges leave the pattern") {
  CarvedGraph graph({5, 6, 6});
  fill_ring(*graph);
  REQUIRE(graph->remove_node(2) == Status::kOk);
  CarvedPattern pattern({5, 6, 5, 15});
  REQUIRE(pattern->build(*graph) == Status::kOk);
  CHECK(pattern->columns() == 4);
  CHECK(pattern->pairs() == 3);
  CHECK(pattern->edge_slot(1).slot == -1);
}

TEST_CASE("one pair, node or edge more than declared is refused") {
  CarvedGraph graph({5, 6, 6});
  fill_ring(*graph);
  CHECK(CarvedPattern({5, 6, 4, 15})->build(*graph) == Status::kCapacity);
  CHECK(CarvedPattern({4, 6, 5, 15})->build(*graph) == Status::kCapacity);
  CHECK(CarvedPattern({5, 5, 5, 15})->build(*graph) == Status::kCapacity);
}

TEST_CASE("nothing free is not ready") {
  CarvedGraph graph({1, 1, 1});
  CarvedPattern pattern({1, 1, 1, 1});
  CHECK(pattern->build(*graph) == Status::kNotReady);
  int32_t id = -1;
  REQUIRE(graph->add_node(NodeKind::kKeyframe, Sim3(), &id) == Status::kOk);
  REQUIRE(graph->set_fixed(id, true) == Status::kOk);
  CHECK(pattern->build(*graph) == Status::kNotReady);
}
