// SPDX-License-Identifier: MIT
// Whole small graphs solved to the poses of the reference.
#include "tests/golden/stored.hpp"
#include "tests/support/catch.hpp"

using namespace unisim;
using unisim_test::difference;
using unisim_test::Numbers;

namespace {

using Lines = std::vector<std::vector<std::string>>;

int32_t count(const Lines& lines, const std::string& word) {
  int32_t n = 0;
  for (const auto& line : lines) n += line[0] == word ? 1 : 0;
  return n;
}

struct StoredGraph {
  explicit StoredGraph(const std::string& name) : StoredGraph(unisim_test::stored_lines(name)) {}
  explicit StoredGraph(const Lines& lines)
      : nodes(count(lines, "node")),
        edges(count(lines, "edge")),
        graph({nodes, edges, 2 * edges}),
        lm({nodes, edges, edges, static_cast<int32_t>(dense_factor_blocks(nodes))}) {
    for (const auto& line : lines) {
      if (line[0] == "node") add_node(line);
      if (line[0] == "edge") add_edge(line);
      if (line[0] == "cost") {
        Numbers numbers(line, 1);
        start_cost = numbers.next();
        solved_cost = numbers.next();
      }
    }
  }

  void add_node(const std::vector<std::string>& line) {
    Numbers numbers(line, 1);
    const NodeKind kind = numbers.word() == "T" ? NodeKind::kKeyframe : NodeKind::kSubmap;
    const bool fixed = numbers.next_index() != 0;
    int32_t id = -1;
    REQUIRE(graph->add_node(kind, numbers.pose(), &id) == Status::kOk);
    REQUIRE(graph->set_fixed(id, fixed) == Status::kOk);
    solved.push_back(numbers.pose());
  }

  void add_edge(const std::vector<std::string>& line) {
    Numbers numbers(line, 1);
    const std::string factor = numbers.word();
    const int32_t a = numbers.next_index();
    const int32_t b = numbers.next_index();
    EdgeWeight weight;
    weight.information = numbers.next();
    weight.kernel.kind =
        numbers.word() == "gm" ? RobustKernelKind::kGemanMcClure : RobustKernelKind::kHuber;
    weight.kernel.delta = numbers.next();
    int32_t id = -1;
    Status status = Status::kInternal;
    if (factor == "two_view") status = graph->add_two_view(a, b, numbers.pose(), weight, &id);
    if (factor == "bridge") status = graph->add_bridge(a, b, numbers.pose(), weight, &id);
    if (factor == "tie") {
      const Sim3 P = numbers.pose();
      status = graph->add_tie(a, b, P, numbers.pose(), weight, &id);
    }
    if (factor == "scale_anchor") {
      status = graph->add_scale_anchor(a, b, numbers.next(), weight, &id);
    }
    if (factor == "scale") status = graph->add_scale(a, b, numbers.next(), weight, &id);
    REQUIRE(status == Status::kOk);
  }

  double largest_difference() {
    double largest = 0.0;
    for (int32_t id = 0; id < nodes; ++id) {
      largest = std::max(largest, difference(graph->pose(id), solved[static_cast<size_t>(id)]));
    }
    return largest;
  }

  int32_t nodes;
  int32_t edges;
  unisim_test::CarvedGraph graph;
  unisim_test::CarvedLm lm;
  std::vector<Sim3> solved;
  double start_cost = 0.0;
  double solved_cost = 0.0;
};

LmOptions to_the_end() {
  LmOptions options;
  options.max_iterations = 200;
  options.cost_tolerance = 1e-15;
  options.step_tolerance = 1e-12;
  return options;
}

}  // namespace

TEST_CASE("a graph of exact measurements is solved to cost zero") {
  StoredGraph stored("graph_exact.txt");
  CHECK(stored.graph->cost() == Approx(stored.start_cost).epsilon(1e-12));
  LmReport report;
  REQUIRE(stored.lm->optimize(&*stored.graph, to_the_end(), &report) == Status::kOk);
  CHECK(report.final_cost < 1e-25);  // roundoff of 161 residuals
  CHECK(stored.largest_difference() < 1e-10);
}

TEST_CASE("the defaults get there in few iterations") {
  StoredGraph stored("graph_exact.txt");
  LmReport report;
  REQUIRE(stored.lm->optimize(&*stored.graph, {}, &report) == Status::kOk);
  CHECK(report.stop == LmStop::kConverged);
  CHECK(report.iterations <= 6);
  CHECK(stored.largest_difference() < 1e-5);
}

TEST_CASE("a noisy graph with loops is solved to the reference's optimum") {
  StoredGraph stored("graph_noisy.txt");
  CHECK(stored.graph->cost() == Approx(stored.start_cost).epsilon(1e-12));
  LmReport report;
  REQUIRE(stored.lm->optimize(&*stored.graph, to_the_end(), &report) == Status::kOk);
  CHECK(report.final_cost == Approx(stored.solved_cost).epsilon(1e-10));
  CHECK(stored.largest_difference() < 1e-6);  // flat directions: cost differs by its square only
}

TEST_CASE("with Geman-McClure false loops end in the reference's optimum") {
  StoredGraph stored("graph_false_loops.txt");
  CHECK(stored.graph->cost() == Approx(stored.start_cost).epsilon(1e-12));
  LmReport report;
  REQUIRE(stored.lm->optimize(&*stored.graph, to_the_end(), &report) == Status::kOk);
  CHECK(report.final_cost == Approx(stored.solved_cost).epsilon(1e-8));
  CHECK(stored.largest_difference() <
        1e-4);  // IRLS stops early along directions of little curvature
}
