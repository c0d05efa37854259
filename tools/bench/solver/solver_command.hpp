// SPDX-License-Identifier: MIT
// unisim-bench solver: the solver of the core on a pose graph from a file.
#pragma once

#include <cstdint>
#include <string>

namespace unisim::bench {

struct SolverSettings {
  std::string graph;
  int32_t repeat = 1;
  int32_t max_iterations = 100;
  double initial_lambda = 0.0;  ///< 0: the solver's default
  bool json = false;
};

/// Print one result per repetition. @return exit code
/// @throws sequence::InputError, replay::Failure
int solver_command(const SolverSettings& settings);

}  // namespace unisim::bench
