// SPDX-License-Identifier: MIT
// The measured optimisation of a graph file: cost by definition, trace, phases.
#include "tools/bench/solver/solver_run.hpp"

#include <numeric>
#include <sstream>

#include "tests/bench/graph_of.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/recorded_data.hpp"
#include "tools/bench/solver/problem.hpp"

using namespace unisim;
using namespace unisim::bench;

namespace {

constexpr double kTinyGrid3D = 3.3639408107431676;
constexpr double kSmallGrid3D = 229.07689232365948;
constexpr double kParkingGarage = 0.6193452899774295;
constexpr double kSphere2500 = 363.5748336240913;

SolverRun solve(const PoseGraph& graph) {
  LmOptions options;
  options.max_iterations = 50;
  return run_solver(graph, needed_factor_blocks(graph), options, {});
}

// A square walked twice with measurements that do not quite agree.
std::string square() {
  std::ostringstream text;
  text << "node 0 T 1 0 0 0 1 0 0 0 1\n";
  for (int k = 1; k < 8; ++k) {
    text << "node " << k << " T 0 0 0 " << (k % 2 == 0 ? 0.1 : -0.1) << " 1 " << k
         << " 0.2 0 1.1\n";
    text << "edge v2v " << k - 1 << ' ' << k << " 1 0.1 0 0 0.70710678 0.70710678 1 0 0.01 1.02\n";
  }
  for (int k = 4; k < 8; ++k) {
    text << "edge v2v " << k - 4 << ' ' << k << " 2 0 0 0 0.01 1 0.02 0 0 1\n";
  }
  return text.str();
}

}  // namespace

TEST_CASE("the cost of an edge is its weight times the Huber function of the residual's norm") {
  const std::string nodes = "node 0 T 1 0 0 0 1 0 0 0 1\nnode 1 T 0 0 0 0 1 3 4 0 1\n";
  const std::string identity = "0 0 0 1 0 0 0 1";
  // |e| = 5: 2 * 25 / 2, then 2 * 1 * (5 - 0.5).
  CHECK(solve(graph_of(nodes + "edge v2v 0 1 2 0 " + identity + "\n")).first_cost == Approx(25.0));
  CHECK(solve(graph_of(nodes + "edge v2v 0 1 2 1 " + identity + "\n")).first_cost == Approx(9.0));
  // e = log 1 - log 1 - 0.5 on the scale, besides an edge without error: 50 * 0.25 / 2.
  const std::string exact = "edge v2v 0 1 1 0 0 0 0 1 3 4 0 1\n";
  CHECK(solve(graph_of(nodes + exact + "edge scale 0 1 50 0 0.5\n")).first_cost == Approx(6.25));
}

TEST_CASE("the trace goes down from the first cost to the last, in growing time") {
  const SolverRun run = solve(graph_of(square()));
  REQUIRE(run.status == Status::kOk);
  REQUIRE(run.report.stop == LmStop::kConverged);
  REQUIRE(run.trace.size() == static_cast<size_t>(run.report.accepted) + 1);
  CHECK(run.trace.front().second == Approx(run.first_cost));
  CHECK(run.trace.back().second == Approx(run.cost));
  CHECK(run.cost < 0.1 * run.first_cost);
  for (size_t k = 1; k < run.trace.size(); ++k) {
    CHECK(run.trace[k].first >= run.trace[k - 1].first);
    CHECK(run.trace[k].second <= run.trace[k - 1].second);
  }
}

TEST_CASE("the phases make up the time of the solve") {
  const SolverRun run = solve(graph_of(square()));
  const double sum = std::accumulate(run.phase_ms.begin(), run.phase_ms.end(), 0.0);
  CHECK(sum <= run.solve_ms);
  CHECK(sum > 0.5 * run.solve_ms);
  CHECK(run.phase_ms[static_cast<size_t>(LmPhase::kLinearize)] > 0.0);
  CHECK(run.phase_ms[static_cast<size_t>(LmPhase::kFactorize)] > 0.0);
}

TEST_CASE("the factor's declared size is the one the solver needs") {
  const PoseGraph graph = graph_of(square());
  const int32_t needed = needed_factor_blocks(graph);
  LmOptions options;
  LmReport report;
  Problem exact(graph, needed);
  CHECK(exact.solver().optimize(&exact.graph(), options, &report) == Status::kOk);
  CHECK(report.factor_blocks == needed);
  Problem small(graph, needed - 1);
  CHECK(small.solver().optimize(&small.graph(), options, &report) == Status::kCapacity);
}

// Half of g2o's chi2 where this solver stops, from the poses in the file: a guard against
// regressions.
TEST_CASE("pose graphs on SE(3) end at the stored costs") {
  struct Known {
    const char* name;
    double cost;
  };
  for (const Known& known :
       {Known{"tinyGrid3D", kTinyGrid3D}, Known{"smallGrid3D", kSmallGrid3D},
        Known{"parking-garage", kParkingGarage}, Known{"sphere2500", kSphere2500}}) {
    const std::string path = recorded_data(std::string("pose_graphs/") + known.name + ".g2o");
    UNISIM_SKIP_WITHOUT(path);
    const SolverRun run = solve(read_pose_graph(path));
    CAPTURE(known.name);
    CHECK(run.status == Status::kOk);
    CHECK(run.report.initial_cost == Approx(run.first_cost));
    CHECK(run.cost == Approx(known.cost).epsilon(1e-6));
  }
}
