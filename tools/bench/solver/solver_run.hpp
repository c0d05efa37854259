// SPDX-License-Identifier: MIT
// One optimisation of a graph file, measured.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/solve/lm.hpp"
#include "drivers/pipeline/heap_watch.hpp"
#include "tools/bench/solver/pose_graph.hpp"

namespace unisim::bench {

inline constexpr size_t kPhases = static_cast<size_t>(LmPhase::kEnd);

/// Times are process CPU time [ms].
struct SolverRun {
  Status status = Status::kOk;
  LmReport report;
  double setup_ms = 0.0;  ///< graph and solver from the file's records
  double solve_ms = 0.0;  ///< the optimisation, ordering and analysis included
  double first_cost = 0.0;
  double cost = 0.0;  ///< evaluated after the run, edge by edge
  int64_t resident_peak_kb = 0;
  int64_t heap_calls = 0;  ///< during the optimisation
  size_t arena_bytes = 0;
  std::array<double, kPhases> phase_ms{};        ///< by LmPhase
  std::vector<std::pair<double, double>> trace;  ///< (ms since the start, cost) of each state taken
};

/// @param factor_blocks needed_factor_blocks()
/// @param options its observer is replaced
/// @param heap    of the program; may be empty
/// @throws replay::Failure when the core refuses the graph
SolverRun run_solver(const PoseGraph& source, int32_t factor_blocks, LmOptions options,
                     const pipeline::HeapWatch& heap);

}  // namespace unisim::bench
