// SPDX-License-Identifier: MIT
// unisim-bench: times and memory of the solver, of a session on a long walk, of depth ratios.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "drivers/replay/text_file.hpp"
#include "tools/bench/solver/solver_command.hpp"
#include "tools/replay/failure.hpp"

namespace {

using namespace unisim::bench;

int fail(int code, const char* line) {
  std::fprintf(stderr, "unisim-bench: %s\n", line);
  return code;
}

void add_solver(CLI::App* app, SolverSettings* settings) {
  CLI::App* command = app->add_subcommand("solver", "Solve a pose graph of a file");
  command->add_option("graph", settings->graph, "GRAPH.usg or GRAPH.g2o")->required();
  command->add_option("--repeat", settings->repeat, "runs, one result each")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-iterations", settings->max_iterations, "cap of one run")
      ->check(CLI::PositiveNumber);
  command->add_option("--initial-lambda", settings->initial_lambda, "start damping")
      ->check(CLI::PositiveNumber);
  command->add_flag("--json", settings->json, "one line of JSON per run");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times and memory of libunisim; times are CPU time of the process.");
  app.require_subcommand(1);
  SolverSettings solver;
  add_solver(&app, &solver);
  try {
    app.parse(argc, argv);
    return solver_command(solver);
  } catch (const CLI::CallForHelp&) {
    std::printf("%s", app.help().c_str());
    return unisim::replay::kExitDone;
  } catch (const CLI::ParseError& error) {
    return fail(unisim::replay::kExitUsage, error.what());
  } catch (const unisim::sequence::InputError& error) {
    return fail(unisim::replay::kExitInput, error.what());
  } catch (const unisim::replay::Failure& failure) {
    return fail(failure.code(), failure.what());
  } catch (const std::exception& error) {
    return fail(unisim::replay::kExitOther, error.what());
  }
}
