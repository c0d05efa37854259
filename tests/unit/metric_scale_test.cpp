// SPDX-License-Identifier: MIT
// The metre in the graph: it follows the evidence, and what has to go along does.
#include "core/map/metric_scale.hpp"

#include <cmath>

#include "core/map/gauge.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::Carved;
using unisim_test::CarvedGraph;
using unisim_test::CarvedLm;

namespace {

constexpr int32_t kNodes = 12;

/// Submaps 0, 1, 2 ... one unit apart, each link as sure as the last argument says.
struct Chain {
  explicit Chain(const std::vector<double>& scales, double information = 1.0)
      : graph({kNodes, 40, 20, 4}),
        metric(kNodes),
        gauge(kNodes),
        solver(SolverCapacity{kNodes, 40, 40, 78}) {
    for (const double s : scales) {
      Sim3 T = Sim3::scaling(s);
      T.t[0] = static_cast<double>(nodes.size());
      int32_t id = -1;
      REQUIRE(is_ok(graph->add_node(NodeKind::kSubmap, T, &id)));
      nodes.push_back(id);
      if (nodes.size() == 1) continue;
      const int32_t before = nodes[nodes.size() - 2];
      EdgeWeight weight;
      weight.information = information;
      int32_t edge = -1;
      const Sim3 Z = between(graph->pose(before), T);
      REQUIRE(is_ok(graph->add_bridge(before, id, Z, weight, &edge)));
    }
  }
  void show(int32_t segment = 0) {
    for (const int32_t node : nodes) REQUIRE(is_ok(metric->show(node, segment, &*graph)));
    REQUIRE(is_ok(metric->drop_unused(&*graph)));
  }
  LmReport solve() {
    REQUIRE(is_ok(gauge->apply(&*graph)));
    LmReport report;
    LmOptions options;
    options.max_iterations = 50;
    REQUIRE(is_ok(solver->optimize(&*graph, options, &report)));
    return report;
  }
  double metres_per_unit() { return 1.0 / graph->pose(metric->metre(0)).s; }

  CarvedGraph graph;
  Carved<MetricScale, int32_t> metric;
  Carved<Gauge, int32_t> gauge;
  CarvedLm solver;
  std::vector<int32_t> nodes;
};

ScaleEvidence metres(double length, double sigma) {
  return {std::log(length), 1.0 / (sigma * sigma)};
}

}  // namespace

TEST_CASE("without evidence the graph has no metre") {
  Chain chain({1.0, 1.0});
  chain.show();
  CHECK(chain.metric->empty());
  CHECK(chain.metric->metre(0) == -1);
  CHECK(chain.graph->node_count() == 2);
}

TEST_CASE("the metre of a consistent map is what its submaps say, and the map stays") {
  // Units of 1, 2 and 0.5 world units; a world unit has three metres.
  Chain chain({1.0, 2.0, 0.5});
  chain.metric->add(chain.nodes[0], metres(3.0, 0.01));
  chain.metric->add(chain.nodes[1], metres(6.0, 0.02));
  chain.metric->add(chain.nodes[2], metres(1.5, 0.02));
  chain.show();
  const Sim3 before = chain.graph->pose(chain.nodes[2]);
  chain.solve();
  CHECK(chain.metres_per_unit() == Approx(3.0).epsilon(1e-9));
  CHECK(unisim_test::difference(before, chain.graph->pose(chain.nodes[2])) < 1e-9);
}

TEST_CASE("the metre is as sure as its evidence where the map is much surer") {
  Chain chain({1.0, 1.0, 1.0}, 1e8);
  for (const int32_t node : chain.nodes) chain.metric->add(node, metres(2.0, 0.03));
  chain.show();
  chain.solve();
  Mat7 covariance;
  REQUIRE(
      is_ok(chain.solver->marginal_covariance(*chain.graph, chain.metric->metre(0), &covariance)));
  const double sigma = std::sqrt(covariance(6, 6) * chain.metric->unit_variance());
  CHECK(sigma == Approx(0.03 / std::sqrt(3.0)).epsilon(1e-3));
}

TEST_CASE("a submap whose unit is off is drawn back by sure evidence") {
  Chain chain({1.0, 1.2});
  chain.metric->add(chain.nodes[0], metres(1.0, 1e-4));
  chain.metric->add(chain.nodes[1], metres(1.0, 1e-4));
  chain.show();
  chain.solve();
  CHECK(chain.graph->pose(chain.nodes[1]).s == Approx(1.0).epsilon(2e-3));
}

TEST_CASE("evidence that is replaced is not counted twice, and kept once it is closed") {
  Chain chain({1.0});
  const int32_t node = chain.nodes[0];
  chain.metric->set_open(node, metres(2.0, 0.1));
  chain.metric->set_open(node, metres(3.0, 0.1));
  CHECK(chain.metric->evidence(node).log_metres == Approx(std::log(3.0)));
  CHECK(chain.metric->evidence(node).information == Approx(100.0));
  chain.metric->close(node);
  chain.metric->set_open(node, {});
  CHECK(chain.metric->evidence(node).log_metres == Approx(std::log(3.0)));
}

TEST_CASE("a node that merges hands its evidence over in the other's unit") {
  Chain chain({1.0, 2.0});
  chain.metric->add(chain.nodes[1], metres(6.0, 0.1));
  chain.metric->merge(chain.nodes[1], chain.nodes[0], std::log(2.0), 0.03);
  CHECK_FALSE(chain.metric->evidence(chain.nodes[1]).known());
  CHECK(chain.metric->evidence(chain.nodes[0]).log_metres == Approx(std::log(3.0)));
  CHECK(chain.metric->evidence(chain.nodes[0]).information == Approx(1.0 / (0.01 + 0.03)));
}

TEST_CASE("the metre goes with its last evidence") {
  Chain chain({1.0, 1.0});
  chain.metric->add(chain.nodes[1], metres(6.0, 0.1));
  chain.show();
  CHECK(chain.graph->node_count() == 3);
  REQUIRE(is_ok(chain.graph->remove_node(chain.nodes[1])));
  chain.metric->forget(chain.nodes[1]);
  chain.nodes.pop_back();
  chain.show();
  CHECK(chain.graph->node_count() == 1);
  CHECK(chain.metric->metre(0) == -1);
}

TEST_CASE("a segment that joins another one gives its metre up and keeps its evidence") {
  Chain chain({1.0, 1.0});
  chain.metric->add(chain.nodes[0], metres(2.0, 0.1));
  chain.metric->add(chain.nodes[1], metres(2.0, 0.1));
  REQUIRE(is_ok(chain.metric->show(chain.nodes[0], 0, &*chain.graph)));
  REQUIRE(is_ok(chain.metric->show(chain.nodes[1], 1, &*chain.graph)));
  CHECK(chain.metric->metres() == 2);
  REQUIRE(is_ok(chain.metric->release(1, &*chain.graph)));
  chain.show(0);
  CHECK(chain.metric->metres() == 1);
  CHECK(chain.metric->metre(1) == -1);
  CHECK(chain.graph->edge_count() == 3);  // the link and two metric edges
}

TEST_CASE("more segments than metres: that of the first goes") {
  CarvedGraph roomy({40, 80, 20, 4});
  Carved<MetricScale, int32_t> metric(40);
  int32_t first = -1;
  for (int32_t k = 0; k <= kMostMetres; ++k) {
    int32_t node = -1;
    REQUIRE(is_ok(roomy->add_node(NodeKind::kSubmap, Sim3(), &node)));
    if (k == 0) first = node;
    metric->add(node, metres(2.0, 0.1));
    REQUIRE(is_ok(metric->show(node, k, &*roomy)));
  }
  CHECK(metric->metres() == kMostMetres);
  CHECK(metric->metre(0) == -1);
  CHECK(metric->metre(kMostMetres) >= 0);
  // It stays so: the older one takes nobody's place.
  REQUIRE(is_ok(metric->show(first, 0, &*roomy)));
  CHECK(metric->metre(0) == -1);
  CHECK(metric->metre(1) >= 0);
}
