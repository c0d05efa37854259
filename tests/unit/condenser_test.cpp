// SPDX-License-Identifier: MIT
// A small graph condensed to one chain edge.
#include "core/solve/factor/condenser.hpp"

#include "core/graph/two_view.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::about_z;
using unisim_test::difference;
using CarvedCondenser = unisim_test::Carved<Condenser, GraphCapacity>;

namespace {

int32_t add_node(Graph& graph, const Sim3& pose) {
  int32_t id = -1;
  REQUIRE(graph.add_node(NodeKind::kKeyframe, pose, &id) == Status::kOk);
  return id;
}

void add_edge(Graph& graph, int32_t a, int32_t b, const Sim3& Z, double information) {
  int32_t id = -1;
  REQUIRE(graph.add_two_view(a, b, Z, {information, 1.0, {}}, &id) == Status::kOk);
}

}  // namespace

TEST_CASE("two edges in a row condense to their product and the sum of their covariances") {
  CarvedCondenser condenser(GraphCapacity{3, 2, 2});
  const Sim3 Z_a_c = about_z(0.3, 1.0, 0.2, 0.0, 1.1);
  const Sim3 Z_c_b = about_z(-0.2, 0.5, 0.0, 0.3, 0.9);
  Graph& graph = condenser->graph();
  const int32_t a = add_node(graph, Sim3());
  const int32_t c = add_node(graph, Sim3());
  const int32_t b = add_node(graph, Sim3());
  add_edge(graph, a, c, Z_a_c, 2.0);
  add_edge(graph, c, b, Z_c_b, 5.0);
  ChainLink link;
  REQUIRE(condenser->condense(a, b, &link));
  CHECK(difference(link.Z_a_b, Z_a_c * Z_c_b) < 1e-9);
  const Mat7 Ad = sim3_adjoint(Z_c_b.inverse());
  const Mat7 covariance = 0.5 * Ad * Ad.transpose() + 0.2 * Mat7::Identity();
  CHECK(difference(link.Lambda * covariance, Mat7::Identity()) < 1e-8);
}

TEST_CASE("parallel edges condense to the sum of their informations, again and again") {
  CarvedCondenser condenser(GraphCapacity{3, 3, 3});
  const Sim3 Z = about_z(0.3, 1.0, 0.2, 0.0, 1.1);
  for (int round = 0; round < 3; ++round) {
    condenser->clear();
    Graph& graph = condenser->graph();
    const int32_t a = add_node(graph, Sim3());
    const int32_t b = add_node(graph, Z);
    add_node(graph, Sim3());  // joined to nothing
    add_edge(graph, a, b, Z, 2.0);
    add_edge(graph, a, b, Z, 3.0);
    ChainLink link;
    REQUIRE(condenser->condense(a, b, &link));
    CHECK(difference(link.Lambda, 5.0 * Mat7::Identity()) < 1e-9);
    REQUIRE(condenser->condense(b, a, &link));
    CHECK(difference(link.Z_a_b, Z.inverse()) < 1e-9);
  }
}

TEST_CASE("what pose factors do not join cannot be condensed") {
  CarvedCondenser condenser(GraphCapacity{2, 1, 1});
  Graph& graph = condenser->graph();
  const int32_t a = add_node(graph, Sim3());
  const int32_t b = add_node(graph, Sim3());
  ChainLink link;
  CHECK_FALSE(condenser->condense(a, b, &link));
  int32_t id = -1;
  REQUIRE(graph.add_scale(a, b, 0.1, {}, &id) == Status::kOk);
  CHECK_FALSE(condenser->condense(a, b, &link));
}
