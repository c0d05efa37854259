// SPDX-License-Identifier: MIT
// A solver that follows a graph through its changes, against one that sees it for the first time.
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::CarvedGraph;
using unisim_test::CarvedLm;
using unisim_test::difference;
using unisim_test::Random;

namespace {

constexpr int32_t kNodes = 120;
constexpr int32_t kEdges = 500;
const SolverCapacity kSolver = {kNodes, kEdges, kEdges, 3000};

// Two graphs that change alike: a chain that grows at its end, with loops, cuts and new
// measurements now and then. Measurements are exact but for a small error.
struct Twins {
  explicit Twins(uint32_t seed)
      : random(seed), one({kNodes, kEdges, 2 * kEdges, 0}), other({kNodes, kEdges, 2 * kEdges, 0}) {
    add_node();
    both([](Graph& graph) { REQUIRE(graph.set_fixed(0, true) == Status::kOk); });
  }

  template <class Change>
  void both(Change change) {
    change(*one);
    change(*other);
  }
  int32_t newest() const { return static_cast<int32_t>(truth.size()) - 1; }
  void add_node() {
    const Sim3 step = random.pose(1.0, 0.3, 0.05);
    truth.push_back(truth.empty() ? step : truth.back() * step);
    const Sim3 start = truth.back() * random.pose(0.02, 0.02, 0.01);
    both([&](Graph& graph) {
      int32_t id = -1;
      REQUIRE(graph.add_node(NodeKind::kKeyframe, start, &id) == Status::kOk);
      REQUIRE(id == newest());
    });
  }
  Sim3 measured(int32_t a, int32_t b) {
    return between(truth[static_cast<size_t>(a)], truth[static_cast<size_t>(b)]) *
           random.pose(0.002, 0.002, 0.001);
  }
  void join(int32_t a, int32_t b) {
    if (a == b || a < 0) return;
    const Sim3 Z = measured(a, b);
    both([&](Graph& graph) {
      int32_t id = -1;
      REQUIRE(graph.add_bridge(a, b, Z, {}, &id) == Status::kOk);
      edge = id;
    });
  }
  void grow() {
    add_node();
    join(newest() - 1, newest());
    join(newest() - 2, newest());
    if (newest() % 3 == 0) join(newest() - 7, newest());
  }
  void change_at_random() {
    const int32_t kind = random.below(6);
    const int32_t id = random.below(one->edge_end());
    if (kind == 0) join(random.below(newest()), newest());
    if (kind == 1 && one->has_edge(id) && id > 10) {
      const Edge gone = one->edge(id);
      if (gone.b - gone.a > 1) {
        both([&](Graph& graph) { REQUIRE(graph.remove_edge(id) == Status::kOk); });
      }
    }
    if (kind == 2 && one->has_edge(id)) {
      const Sim3 Z = measured(one->edge(id).a, one->edge(id).b);
      both([&](Graph& graph) { REQUIRE(graph.set_measurement(id, Z) == Status::kOk); });
    }
    if (kind == 3 && one->has_edge(id)) {
      both([&](Graph& graph) { REQUIRE(graph.set_multiplier(id, 0.5) == Status::kOk); });
    }
    if (kind == 4 && one->has_edge(id)) {
      const bool suspended = one->edge(id).b - one->edge(id).a > 1;
      both([&](Graph& graph) { REQUIRE(graph.set_suspended(id, suspended) == Status::kOk); });
    }
  }
  double apart() const {
    double largest = 0.0;
    for (int32_t id = 0; id <= newest(); ++id) {
      largest = std::max(largest, difference(const_cast<CarvedGraph&>(one)->pose(id),
                                             const_cast<CarvedGraph&>(other)->pose(id)));
    }
    return largest;
  }

  Random random;
  CarvedGraph one;
  CarvedGraph other;
  std::vector<Sim3> truth;
  int32_t edge = -1;
};

LmOptions precise() {
  LmOptions options;
  options.max_iterations = 20;
  options.cost_tolerance = 1e-12;
  return options;
}

}  // namespace

TEST_CASE("a solver that follows the changes ends where a new one does") {
  for (uint32_t seed = 1; seed <= 12; ++seed) {
    Twins twins(seed);
    CarvedLm follower(kSolver);
    LmOptions following = precise();
    following.least_move = 1e-9;
    following.relinearize = seed % 3 == 0 ? 0.0 : std::pow(10.0, -static_cast<double>(seed % 3));
    for (int32_t k = 1; k < kNodes; ++k) {
      twins.grow();
      if (k > 12) twins.change_at_random();
      LmReport report;
      REQUIRE(follower->optimize(&*twins.one, following, &report) == Status::kOk);
      CHECK(report.final_cost == Approx(twins.one->cost()).epsilon(1e-9).margin(1e-15));
      if (k % 17 != 0) continue;
      CAPTURE(seed, k);
      CarvedLm fresh(kSolver);
      REQUIRE(fresh->optimize(&*twins.other, precise(), &report) == Status::kOk);
      CHECK(twins.apart() < 1e-6);
    }
  }
}

TEST_CASE("covariances of a solver that follows the changes are those of a new one") {
  Twins twins(40);
  CarvedLm follower(kSolver);
  LmOptions following = precise();
  following.least_move = 1e-9;
  following.relinearize = 1e-2;
  for (int32_t k = 1; k < 60; ++k) {
    twins.grow();
    if (k > 12) twins.change_at_random();
    LmReport report;
    REQUIRE(follower->optimize(&*twins.one, following, &report) == Status::kOk);
    CHECK(report.final_cost == Approx(twins.one->cost()).epsilon(1e-9).margin(1e-15));
    if (k % 5 != 0) continue;
    const int32_t node = 1 + twins.random.below(k);
    Mat7 followed;
    REQUIRE(follower->marginal_covariance(*twins.one, node, &followed) == Status::kOk);
    CarvedLm fresh(kSolver);
    REQUIRE(fresh->optimize(&*twins.other, precise(), &report) == Status::kOk);
    CHECK(twins.apart() < 1e-6);
    Mat7 expected;
    REQUIRE(fresh->marginal_covariance(*twins.other, node, &expected) == Status::kOk);
    CHECK(difference(followed, expected) < 1e-4 * expected.norm());
  }
}
