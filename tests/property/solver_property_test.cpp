// SPDX-License-Identifier: MIT
// Sparse block Cholesky against dense Eigen on random graphs; gauge freedom of the whole solver.
#include <optional>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::Carved;
using unisim_test::CarvedGraph;
using unisim_test::CarvedLm;
using unisim_test::difference;
using unisim_test::Random;

namespace {

using Dense = Eigen::MatrixXd;

// Random connected graph of n nodes with about `extra` more edges, exact measurements or noisy
// ones.
struct RandomGraph {
  RandomGraph(uint32_t seed, int32_t n, int32_t extra, double noise)
      : capacity{n, n + extra, n + extra, static_cast<int32_t>(dense_factor_blocks(n))},
        graph({n, n + extra, 2 * (n + extra)}) {
    Random random(seed);
    int32_t id = -1;
    for (int32_t i = 0; i < n; ++i) {
      truth.push_back(random.pose(2.0, 3.0, 0.4));
      REQUIRE(graph->add_node(i % 5 == 4 ? NodeKind::kSubmap : NodeKind::kKeyframe, truth.back(),
                              &id) == Status::kOk);
    }
    for (int32_t k = 0; k < n - 1 + extra; ++k) {
      const int32_t b = k < n - 1 ? k + 1 : random.below(n);
      const int32_t a = k < n - 1 ? random.below(k + 1) : random.below(n);
      if (a != b) add_edge(random, a, b, noise);
    }
  }

  void add_edge(Random& random, int32_t a, int32_t b, double noise) {
    const Sim3& A = truth[static_cast<size_t>(a)];
    const Sim3& B = truth[static_cast<size_t>(b)];
    EdgeWeight weight;
    weight.information = random.uniform(0.5, 2.0);
    const Sim3 error = sim3_exp(random.tangent(noise, noise, noise));
    int32_t id = -1;
    const int32_t kind = random.below(4);
    if (kind == 3) {
      const Sim3 Q = random.pose(1.0, 1.0, 0.2);
      REQUIRE(graph->add_tie(a, b, between(A, B * Q) * error, Q, weight, &id) == Status::kOk);
    } else {
      REQUIRE(graph->add_bridge(a, b, between(A, B) * error, weight, &id) == Status::kOk);
    }
  }

  SolverCapacity capacity;
  CarvedGraph graph;
  std::vector<Sim3> truth;
};

// The parts of a solver on one graph.
struct System {
  System(const Graph& graph, const SolverCapacity& capacity)
      : pattern(capacity), equations(capacity), cholesky(capacity) {
    REQUIRE(pattern->build(graph) == Status::kOk);
    REQUIRE(cholesky->analyze(pattern->column_start(), pattern->rows()) == Status::kOk);
    assembled.emplace(*equations, graph, *pattern);
  }
  Dense H() const { return assembled->dense(); }
  Status factorize(double lambda) {
    assembled->copy_to(*cholesky);
    return cholesky->factorize(lambda);
  }
  Carved<BlockPattern, SolverCapacity> pattern;
  Carved<NormalEquations, SolverCapacity> equations;
  Carved<BlockCholesky, SolverCapacity> cholesky;
  std::optional<unisim_test::Assembled> assembled;
};

}  // namespace

TEST_CASE("sparse solution equals the dense one on random patterns") {
  Random sizes(31);
  for (uint32_t seed = 0; seed < 60; ++seed) {
    const int32_t n = 2 + sizes.below(25);
    RandomGraph random(seed, n, sizes.below(3 * n), 0.1);
    REQUIRE(random.graph->set_fixed(sizes.below(n), true) == Status::kOk);
    System system(*random.graph, random.capacity);
    for (const double lambda : {0.0, 1e-4, 10.0}) {
      CAPTURE(seed, n, lambda);
      Dense H = system.H();
      H.diagonal() *= 1.0 + lambda;
      REQUIRE(system.factorize(lambda) == Status::kOk);
      const int columns = system.pattern->columns();
      std::vector<BlockVector> x(static_cast<size_t>(columns));
      Eigen::VectorXd b(7 * columns);
      for (int j = 0; j < columns; ++j) {
        for (int d = 0; d < 7; ++d) {
          b(7 * j + d) = sizes.uniform(-1, 1);
          x[static_cast<size_t>(j)].v[d] = b(7 * j + d);
        }
      }
      system.cholesky->solve({x.data(), columns});
      const Eigen::VectorXd expected = H.llt().solve(b);
      double largest = 0.0;
      for (int j = 0; j < columns; ++j) {
        for (int d = 0; d < 7; ++d) {
          largest =
              std::max(largest, std::abs(x[static_cast<size_t>(j)].v[d] - expected(7 * j + d)));
        }
      }
      CHECK(largest < 1e-10 * (1.0 + expected.cwiseAbs().maxCoeff()));
    }
  }
}

TEST_CASE("inverse blocks equal those of the dense inverse, in whatever order they are asked for") {
  Random sizes(32);
  for (uint32_t seed = 100; seed < 160; ++seed) {
    const int32_t n = 2 + sizes.below(30);
    // Every third graph is a tree: without the node that is held it falls apart.
    RandomGraph random(seed, n, seed % 3 == 0 ? 0 : sizes.below(3 * n), 0.1);
    REQUIRE(random.graph->set_fixed(sizes.below(n), true) == Status::kOk);
    System system(*random.graph, random.capacity);
    REQUIRE(system.factorize(0.0) == Status::kOk);
    const Dense inverse = system.H().inverse();
    const int32_t columns = system.pattern->columns();
    std::vector<BlockVector> work(static_cast<size_t>(columns));
    for (int32_t k = 0; k < 3 * columns; ++k) {
      CAPTURE(seed, n, k);
      const int32_t j = k < columns ? sizes.below(columns) : k % columns;
      Mat7 block;
      system.cholesky->inverse_block(j, {work.data(), columns}, &block);
      CHECK(difference(block, inverse.block(7 * j, 7 * j, 7, 7)) <
            1e-10 * inverse.cwiseAbs().maxCoeff());
    }
  }
}

TEST_CASE("what an inverse block has taken of the factor is stale, the rest is not") {
  for (uint32_t seed = 160; seed < 180; ++seed) {
    CAPTURE(seed);
    RandomGraph random(seed, 25, 15, 0.1);
    REQUIRE(random.graph->set_fixed(3, true) == Status::kOk);
    System system(*random.graph, random.capacity);
    REQUIRE(system.factorize(0.0) == Status::kOk);
    const int32_t columns = system.pattern->columns();
    std::vector<BlockVector> x(static_cast<size_t>(columns));
    Mat7 block;
    system.cholesky->inverse_block(columns / 2, {x.data(), columns}, &block);
    system.assembled->copy_stale_to(*system.cholesky);
    REQUIRE(system.cholesky->factorize(0.0) == Status::kOk);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(7 * columns, -1.0, 1.0);
    for (int32_t j = 0; j < columns; ++j) {
      x[static_cast<size_t>(j)] = BlockVector{};
      for (int d = 0; d < 7; ++d) x[static_cast<size_t>(j)].v[d] = b(7 * j + d);
    }
    system.cholesky->solve({x.data(), columns});
    const Eigen::VectorXd expected = system.H().llt().solve(b);
    for (int32_t j = 0; j < columns; ++j) {
      const Eigen::Map<const Vec7> found(x[static_cast<size_t>(j)].v);
      CHECK(difference(found, expected.segment<7>(7 * j)) < 1e-10 * expected.cwiseAbs().maxCoeff());
    }
  }
}

TEST_CASE("without a fixed node H is rank deficient and refused, with damping it is not") {
  for (uint32_t seed = 200; seed < 220; ++seed) {
    RandomGraph random(seed, 10, 8, 0.1);
    System system(*random.graph, random.capacity);
    CHECK(system.factorize(0.0) == Status::kNumerical);
    CHECK(system.cholesky->bad_column() == system.pattern->columns() - 1);
    CHECK(system.factorize(1e-4) == Status::kOk);
  }
}

TEST_CASE("an indefinite matrix is refused at or after its bad column") {
  for (uint32_t seed = 300; seed < 320; ++seed) {
    RandomGraph random(seed, 12, 10, 0.1);
    REQUIRE(random.graph->set_fixed(0, true) == Status::kOk);
    System system(*random.graph, random.capacity);
    const int32_t bad = static_cast<int32_t>(seed) % system.pattern->columns();
    system.assembled->diagonal(bad).at(2, 2) *= -1.0;
    CHECK(system.factorize(0.0) == Status::kNumerical);
    CHECK(system.cholesky->bad_column() == bad);
  }
}

TEST_CASE("gauge freedom: moving the whole world moves the solution and keeps the cost") {
  Random random(41);
  for (uint32_t seed = 400; seed < 410; ++seed) {
    RandomGraph here(seed, 14, 12, 0.05);
    RandomGraph there(seed, 14, 12, 0.05);
    const Sim3 world = random.pose(5.0, 3.0, 1.0);
    for (int32_t id = 0; id < 14; ++id) {
      REQUIRE(there.graph->set_pose(id, world * here.graph->pose(id)) == Status::kOk);
    }
    LmOptions options;
    options.max_iterations = 50;
    options.cost_tolerance = 1e-14;
    LmReport report_here;
    LmReport report_there;
    for (RandomGraph* g : {&here, &there}) REQUIRE(g->graph->set_fixed(0, true) == Status::kOk);
    CarvedLm lm(here.capacity);
    REQUIRE(lm->optimize(&*here.graph, options, &report_here) == Status::kOk);
    CarvedLm other(there.capacity);
    REQUIRE(other->optimize(&*there.graph, options, &report_there) == Status::kOk);
    CHECK(report_there.initial_cost == Approx(report_here.initial_cost));
    CHECK(report_there.final_cost == Approx(report_here.final_cost));
    for (int32_t id = 0; id < 14; ++id) {
      CHECK(difference(there.graph->pose(id), world * here.graph->pose(id)) <
            1e-5 * (1.0 + world.s));
    }
  }
}

TEST_CASE("gauge freedom: which node is fixed does not change the cost or the relative poses") {
  for (uint32_t seed = 500; seed < 506; ++seed) {
    RandomGraph first(seed, 12, 12, 0.05);
    RandomGraph last(seed, 12, 12, 0.05);
    REQUIRE(first.graph->set_fixed(0, true) == Status::kOk);
    REQUIRE(last.graph->set_fixed(11, true) == Status::kOk);
    LmOptions options;
    options.max_iterations = 50;
    options.cost_tolerance = 1e-14;
    LmReport a;
    LmReport b;
    CarvedLm lm(first.capacity);
    REQUIRE(lm->optimize(&*first.graph, options, &a) == Status::kOk);
    CarvedLm other(last.capacity);
    REQUIRE(other->optimize(&*last.graph, options, &b) == Status::kOk);
    CHECK(a.final_cost == Approx(b.final_cost));
    CHECK(difference(between(first.graph->pose(2), first.graph->pose(9)),
                     between(last.graph->pose(2), last.graph->pose(9))) < 1e-5);
  }
}

TEST_CASE("the cost never grows from one accepted step to the next") {
  for (uint32_t seed = 600; seed < 610; ++seed) {
    RandomGraph random(seed, 14, 14, 0.8);
    REQUIRE(random.graph->set_fixed(0, true) == Status::kOk);
    CarvedLm lm(random.capacity);
    LmOptions options;
    options.max_iterations = 1;
    double cost = random.graph->cost();
    for (int step = 0; step < 15; ++step) {
      LmReport report;
      const Status status = lm->optimize(&*random.graph, options, &report);
      CHECK((status == Status::kOk || report.stop == LmStop::kNoDescent));
      CHECK(random.graph->cost() <= cost);
      cost = random.graph->cost();
    }
  }
}
