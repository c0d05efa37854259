// SPDX-License-Identifier: MIT
// unisim-bench solver: the solver of the core on a pose graph from a file.
#include "tools/bench/solver/solver_command.hpp"

#include <cmath>
#include <string>

#include "drivers/common/format.hpp"
#include "tools/bench/process.hpp"
#include "tools/bench/solver/problem.hpp"
#include "tools/bench/solver/solver_run.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/heap_counter.hpp"
#include "tools/common/json_text.hpp"
#include "tools/common/output.hpp"

namespace unisim::bench {
namespace {

using tools::Json;

// To the microsecond: below it there is noise only.
double rounded(double ms) { return std::round(ms * 1e3) / 1e3; }

double phase_ms(const SolverRun& run, LmPhase phase) {
  return rounded(run.phase_ms[static_cast<size_t>(phase)]);
}

Json trace_json(const SolverRun& run) {
  Json trace = Json::array();
  for (const auto& [ms, cost] : run.trace) trace.push_back({rounded(ms), cost});
  return trace;
}

// The core sums an edge into H as it linearises it: assembly has no time of its own.
Json split_json(const SolverRun& run) {
  return {{"order", phase_ms(run, LmPhase::kOrder)},
          {"analyse", phase_ms(run, LmPhase::kAnalyze)},
          {"linearise", phase_ms(run, LmPhase::kLinearize)},
          {"assemble", 0.0},
          {"factor", phase_ms(run, LmPhase::kFactorize)},
          {"solve", phase_ms(run, LmPhase::kSolve)},
          {"step", phase_ms(run, LmPhase::kStep) + phase_ms(run, LmPhase::kAccept)}};
}

const char* stop_name(LmStop stop) {
  switch (stop) {
    case LmStop::kConverged:
      return "converged";
    case LmStop::kBudget:
      return "budget";
    case LmStop::kNoDescent:
      return "no descent";
    case LmStop::kNotPositive:
      return "not positive definite";
  }
  return "";
}

Json run_json(const SolverSettings& settings, const PoseGraph& graph, const LmOptions& options,
              int64_t resident_before_kb, const SolverRun& run) {
  return {{"solver", "unisim"},
          {"config", drivers::format("lm/lambda%.0e", options.initial_lambda)},
          {"graph", settings.graph},
          {"nodes", graph.nodes.size()},
          {"edges", graph.edges.size()},
          {"iterations", run.report.iterations},
          {"setup_ms", rounded(run.setup_ms)},
          {"solve_ms", rounded(run.solve_ms)},
          {"cost0", run.first_cost},
          {"cost", run.cost},
          {"rss_before_kb", resident_before_kb},
          {"rss_peak_kb", run.resident_peak_kb},
          {"allocs", run.heap_calls},
          {"alloc_bytes", 0},
          {"arena_bytes", run.arena_bytes},
          {"factor_blocks", run.report.factor_blocks},
          {"stop", stop_name(run.report.stop)},
          {"split_ms", split_json(run)},
          {"trace", trace_json(run)}};
}

std::string table_text(const Json& result) {
  std::string text;
  for (const auto& [key, value] : result.items()) {
    if (key == "split_ms") {
      for (const auto& [phase, ms] : value.items()) {
        text += drivers::format("  %-14s %12.3f\n", phase.c_str(), ms.get<double>());
      }
    } else if (key == "trace") {
      text += drivers::format("%14s %20s\n", "ms", "cost");
      for (const Json& state : value) {
        text += drivers::format("%14.3f %20.12g\n", state[0].get<double>(), state[1].get<double>());
      }
    } else {
      text += drivers::format("%-16s %s\n", key.c_str(), tools::json_text(value).c_str());
    }
  }
  return text;
}

}  // namespace

int solver_command(const SolverSettings& settings) {
  const PoseGraph graph = read_pose_graph(settings.graph);
  const int64_t resident_before_kb = peak_resident_kb();
  LmOptions options;
  options.max_iterations = settings.max_iterations;
  if (settings.initial_lambda > 0.0) options.initial_lambda = settings.initial_lambda;
  const int32_t factor_blocks = needed_factor_blocks(graph);
  for (int32_t i = 0; i < settings.repeat; ++i) {
    const SolverRun run = run_solver(graph, factor_blocks, options, tools::heap_counter());
    const Json result = run_json(settings, graph, options, resident_before_kb, run);
    tools::print(settings.json ? tools::json_text(result) + "\n" : table_text(result));
    if (!is_ok(run.status)) {
      throw tools::Failure(tools::kExitLimit,
                           settings.graph + ": not solved: " + stop_name(run.report.stop));
    }
  }
  return tools::kExitDone;
}

}  // namespace unisim::bench
