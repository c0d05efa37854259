// SPDX-License-Identifier: MIT
// Levenberg-Marquardt: convergence, stops, refusals, covariance.
#include "core/solve/lm.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::about_z;
using unisim_test::CarvedGraph;
using unisim_test::CarvedLm;
using unisim_test::difference;

namespace {

// A ring of n keyframes with exact measurements whose poses have been moved, the first one fixed.
struct Ring {
  explicit Ring(int32_t n, double disturbance = 0.05)
      : graph({n, n, n}), lm({n, n, n, static_cast<int32_t>(dense_factor_blocks(n))}) {
    unisim_test::Random random(4);
    for (int32_t i = 0; i < n; ++i) truth.push_back(random.pose(3.0, 3.0, 0.5));
    int32_t id = -1;
    for (int32_t i = 0; i < n; ++i) {
      const Sim3 start = retract(
          truth[at(i)], random.tangent(i == 0 ? 0.0 : disturbance, i == 0 ? 0.0 : disturbance,
                                       i == 0 ? 0.0 : disturbance));
      REQUIRE(graph->add_node(NodeKind::kKeyframe, start, &id) == Status::kOk);
    }
    for (int32_t i = 0; i < n; ++i) {
      const int32_t j = (i + 1) % n;
      REQUIRE(graph->add_two_view(i, j, between(truth[at(i)], truth[at(j)]), {}, &id) ==
              Status::kOk);
    }
    REQUIRE(graph->set_fixed(0, true) == Status::kOk);
  }
  static size_t at(int32_t i) { return static_cast<size_t>(i); }
  double error() {
    double largest = 0.0;
    for (int32_t i = 0; i < graph->node_end(); ++i) {
      largest = std::max(largest, difference(graph->pose(i), truth[at(i)]));
    }
    return largest;
  }
  CarvedGraph graph;
  CarvedLm lm;
  std::vector<Sim3> truth;
};

}  // namespace

TEST_CASE("a consistent graph is solved to the truth") {
  Ring ring(12);
  REQUIRE(ring.lm.fits());
  LmOptions options;
  options.max_iterations = 30;
  LmReport report;
  REQUIRE(ring.lm->optimize(&*ring.graph, options, &report) == Status::kOk);
  CHECK(report.stop == LmStop::kConverged);
  CHECK(report.final_cost < 1e-15);
  CHECK(report.final_cost == Approx(ring.graph->cost()).margin(1e-20));
  CHECK(ring.error() < 1e-6);
  CHECK(report.bad_node == -1);
  CHECK(report.factor_blocks == 11 + 10);  // the fixed node cuts the ring: a chain fills nothing
}

TEST_CASE("skeleton nodes can be held and released again") {
  Ring ring(12, 0.4);
  const auto pose = [&](int32_t node) { return ring.graph->pose(node); };
  for (const int32_t node : {3, 4}) {
    REQUIRE(is_ok(ring.graph->set_kind(node, NodeKind::kSkeleton)));
  }
  const Sim3 before[2] = {pose(3), pose(4)};
  LmOptions options;
  options.max_iterations = 30;
  options.hold_skeleton = true;
  LmReport report;
  REQUIRE(ring.lm->optimize(&*ring.graph, options, &report) == Status::kOk);
  CHECK(difference(pose(3), before[0]) == 0.0);
  CHECK(difference(pose(4), before[1]) == 0.0);
  CHECK(report.final_cost < report.initial_cost);
  CHECK(report.final_cost == Approx(ring.graph->cost()));
  Mat7 covariance;
  CHECK(ring.lm->marginal_covariance(*ring.graph, 3, &covariance) == Status::kOk);
  options.hold_skeleton = false;
  REQUIRE(ring.lm->optimize(&*ring.graph, options, &report) == Status::kOk);
  CHECK(ring.error() < 1e-6);
}

TEST_CASE("a node that joins the skeleton is held from then on") {
  // Leaves that see the hub and a fixed node: eliminating one leaves the order of the others alone.
  constexpr int32_t kHub = 1;
  constexpr int32_t kLeaves = 12;
  constexpr int32_t kNodes = 2 + kLeaves;
  for (const int32_t joins : {kHub, 7}) {
    unisim_test::Random random(9);
    CarvedGraph graph({kNodes, 2 * kNodes, 2 * kNodes});
    CarvedLm lm({kNodes, 2 * kNodes, 2 * kNodes, dense_factor_blocks(kNodes)});
    int32_t id = -1;
    for (int32_t k = 0; k < kNodes; ++k) {
      REQUIRE(is_ok(graph->add_node(NodeKind::kKeyframe, random.pose(1.0, 1.0, 0.1), &id)));
    }
    REQUIRE(is_ok(graph->set_fixed(0, true)));
    REQUIRE(is_ok(graph->add_two_view(0, kHub, random.pose(1.0, 1.0, 0.1), {}, &id)));
    for (int32_t leaf = 2; leaf < kNodes; ++leaf) {
      REQUIRE(is_ok(graph->add_two_view(0, leaf, random.pose(1.0, 1.0, 0.1), {}, &id)));
      REQUIRE(is_ok(graph->add_two_view(kHub, leaf, random.pose(1.0, 1.0, 0.1), {}, &id)));
    }
    LmOptions options;
    options.max_iterations = 50;
    options.hold_skeleton = true;
    options.relinearize = 10.0;  // so that the order is renewed in parts
    LmReport report;
    REQUIRE(lm->optimize(&*graph, options, &report) == Status::kOk);
    REQUIRE(is_ok(graph->set_kind(joins, NodeKind::kSkeleton)));
    REQUIRE(is_ok(graph->set_measurement(0, random.pose(1.0, 1.0, 0.1))));  // relinks the hub
    const Sim3 before = graph->pose(joins);
    CAPTURE(joins);
    REQUIRE(lm->optimize(&*graph, options, &report) == Status::kOk);
    CHECK(difference(graph->pose(joins), before) == 0.0);
    CHECK(report.final_cost == Approx(graph->cost()));
    CarvedLm fresh({kNodes, 2 * kNodes, 2 * kNodes, dense_factor_blocks(kNodes)});
    LmReport again;
    REQUIRE(fresh->optimize(&*graph, options, &again) == Status::kOk);
    CHECK(again.final_cost == Approx(report.final_cost).epsilon(1e-6));
  }
}

TEST_CASE("the budget ends the work and the cost has not grown") {
  Ring ring(12, 0.4);
  LmOptions options;
  options.max_iterations = 1;
  LmReport report;
  REQUIRE(ring.lm->optimize(&*ring.graph, options, &report) == Status::kOk);
  CHECK(report.stop == LmStop::kBudget);
  CHECK(report.iterations == 1);
  CHECK(report.final_cost <= report.initial_cost);
  options.max_iterations = 0;
  REQUIRE(ring.lm->optimize(&*ring.graph, options, &report) == Status::kOk);
  CHECK(report.iterations == 0);
  CHECK(report.final_cost == report.initial_cost);
}

TEST_CASE("the same input gives the same bits") {
  Ring a(20);
  Ring b(20);
  LmReport report;
  REQUIRE(a.lm->optimize(&*a.graph, {}, &report) == Status::kOk);
  REQUIRE(b.lm->optimize(&*b.graph, {}, &report) == Status::kOk);
  for (int32_t i = 0; i < 20; ++i) CHECK(difference(a.graph->pose(i), b.graph->pose(i)) == 0.0);
}

TEST_CASE("a graph may change between optimisations") {
  Ring ring(12);
  LmReport report;
  REQUIRE(ring.lm->optimize(&*ring.graph, {}, &report) == Status::kOk);
  const int32_t blocks = static_cast<int32_t>(report.factor_blocks);
  REQUIRE(ring.graph->remove_node(6) == Status::kOk);
  REQUIRE(ring.lm->optimize(&*ring.graph, {}, &report) == Status::kOk);
  CHECK(report.factor_blocks < blocks);
  CHECK(ring.graph->cost() < 1e-15);
}

TEST_CASE("separate components are solved together, each with its fixed node") {
  CarvedGraph graph({4, 2, 2});
  CarvedLm lm({4, 2, 2, 10});
  int32_t id = -1;
  for (int i = 0; i < 4; ++i) {
    REQUIRE(graph->add_node(NodeKind::kKeyframe, about_z(0.1 * i, i, 0, 0, 1), &id) == Status::kOk);
  }
  const Sim3 Z = about_z(0.3, 1, 2, 3, 2);
  REQUIRE(graph->add_two_view(0, 1, Z, {}, &id) == Status::kOk);
  REQUIRE(graph->add_two_view(2, 3, Z, {}, &id) == Status::kOk);
  REQUIRE(graph->set_fixed(0, true) == Status::kOk);
  REQUIRE(graph->set_fixed(2, true) == Status::kOk);
  LmOptions options;
  options.max_iterations = 30;
  LmReport report;
  REQUIRE(lm->optimize(&*graph, options, &report) == Status::kOk);
  CHECK(difference(graph->pose(1), graph->pose(0) * Z) < 1e-6);
  CHECK(difference(graph->pose(3), graph->pose(2) * Z) < 1e-6);
}

TEST_CASE("a node that only scale edges hold is named and nothing moves") {
  Ring ring(5);
  int32_t lonely = -1;
  int32_t id = -1;
  CarvedGraph graph({3, 2, 1});
  CarvedLm lm({3, 2, 2, 6});
  REQUIRE(graph->add_node(NodeKind::kKeyframe, Sim3(), &id) == Status::kOk);
  REQUIRE(graph->set_fixed(id, true) == Status::kOk);
  REQUIRE(graph->add_node(NodeKind::kKeyframe, about_z(0.1, 1, 0, 0, 1), &id) == Status::kOk);
  REQUIRE(graph->add_node(NodeKind::kSubmap, Sim3(), &lonely) == Status::kOk);
  REQUIRE(graph->add_two_view(0, 1, Sim3(), {}, &id) == Status::kOk);
  REQUIRE(graph->add_scale_anchor(lonely, 1, 0.2, {}, &id) == Status::kOk);
  const Sim3 before = graph->pose(1);
  LmReport report;
  CHECK(lm->optimize(&*graph, {}, &report) == Status::kNumerical);
  CHECK(report.stop == LmStop::kNotPositive);
  CHECK(report.bad_node == lonely);
  CHECK(report.final_cost == report.initial_cost);
  CHECK(difference(graph->pose(1), before) == 0.0);
  // The missing edge arrives: the next call works.
  REQUIRE(graph->remove_edge(id) == Status::kOk);
  REQUIRE(graph->remove_node(lonely) == Status::kOk);
  LmOptions options;
  options.max_iterations = 30;
  CHECK(lm->optimize(&*graph, options, &report) == Status::kOk);
  CHECK(report.bad_node == -1);
}

TEST_CASE("a large wrong scale is brought back in bounded steps") {
  CarvedGraph graph({2, 1, 1});
  CarvedLm lm({2, 1, 1, 3});
  int32_t id = -1;
  REQUIRE(graph->add_node(NodeKind::kKeyframe, Sim3(), &id) == Status::kOk);
  REQUIRE(graph->set_fixed(id, true) == Status::kOk);
  REQUIRE(graph->add_node(NodeKind::kKeyframe, Sim3::scaling(1e4), &id) == Status::kOk);
  REQUIRE(graph->add_two_view(0, 1, about_z(0.5, 1, 0, 0, 1), {}, &id) == Status::kOk);
  LmOptions options;
  options.max_iterations = 1;
  LmReport report;
  REQUIRE(lm->optimize(&*graph, options, &report) == Status::kOk);
  CHECK(graph->pose(1).s > 1e4 * std::exp(-1.0) * (1.0 - 1e-12));
  options.max_iterations = 60;
  REQUIRE(lm->optimize(&*graph, options, &report) == Status::kOk);
  CHECK(graph->pose(1).s == Approx(1.0).epsilon(1e-5));
}

TEST_CASE("Geman-McClure leaves a false loop behind where least squares follow it") {
  for (const bool robust : {true, false}) {
    Ring ring(10, 0.01);
    EdgeWeight weight;
    if (robust) weight.kernel = {RobustKernelKind::kGemanMcClure, 0.1};
    int32_t id = -1;
    REQUIRE(ring.graph->remove_edge(9) == Status::kOk);  // one edge makes room
    REQUIRE(ring.graph->add_bridge(2, 7, about_z(2, 5, 5, 5, 1), weight, &id) == Status::kOk);
    LmOptions options;
    options.max_iterations = 50;
    LmReport report;
    REQUIRE(ring.lm->optimize(&*ring.graph, options, &report) == Status::kOk);
    CHECK((ring.error() < 0.01) == robust);
  }
}

TEST_CASE("refusals: no edge, no free node, bad options, too small") {
  Ring ring(4);
  LmReport report;
  LmOptions bad;
  bad.initial_lambda = 0.0;
  CHECK(ring.lm->optimize(&*ring.graph, bad, &report) == Status::kInvalidArgument);
  CarvedGraph empty({2, 1, 1});
  CHECK(ring.lm->optimize(&*empty, {}, &report) == Status::kNotReady);
  CarvedLm small({4, 4, 4, 4});
  CHECK(small->optimize(&*ring.graph, {}, &report) == Status::kCapacity);
  CHECK(report.factor_blocks == 5);  // a chain of three free nodes
}

TEST_CASE("marginal covariance of a chain grows by the covariance of each edge") {
  CarvedGraph graph({3, 2, 2});
  CarvedLm lm({3, 2, 2, 6});
  int32_t id = -1;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(graph->add_node(NodeKind::kKeyframe, about_z(0, 2 * i, 0, 0, 1), &id) == Status::kOk);
  }
  REQUIRE(graph->set_fixed(0, true) == Status::kOk);
  EdgeWeight weight;
  weight.information = 4.0;
  const Sim3 Z = about_z(0, 2, 0, 0, 1);
  REQUIRE(graph->add_two_view(0, 1, Z, weight, &id) == Status::kOk);
  REQUIRE(graph->add_two_view(1, 2, Z, weight, &id) == Status::kOk);
  Mat7 covariance;
  REQUIRE(lm->marginal_covariance(*graph, 1, &covariance) == Status::kOk);
  CHECK(difference(covariance, 0.25 * Mat7::Identity()) < 1e-14);
  REQUIRE(lm->marginal_covariance(*graph, 2, &covariance) == Status::kOk);
  const Mat7 Ad = sim3_adjoint(Z.inverse());
  CHECK(difference(covariance, 0.25 * (Mat7::Identity() + Ad * Ad.transpose())) < 1e-13);
  CHECK(lm->marginal_covariance(*graph, 0, &covariance) == Status::kInvalidArgument);
  CHECK(lm->marginal_covariance(*graph, 9, &covariance) == Status::kInvalidArgument);
}
