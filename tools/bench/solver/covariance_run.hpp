// SPDX-License-Identifier: MIT
// Covariances of a solved pose graph, measured.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/pipeline/heap_watch.hpp"
#include "tools/bench/solver/pose_graph.hpp"

namespace unisim::bench {

struct CovarianceSettings {
  std::string graph;
  int32_t repeat = 5;
  bool json = false;
};

/// Times are process CPU time [ms].
struct CovarianceRun {
  int32_t poses = 0;  ///< free keyframes
  int64_t factor_blocks = 0;
  int64_t heap_calls = 0;   ///< during all calls
  double first_ms = 0.0;    ///< of the newest pose, linearisation and factorisation included
  double another_ms = 0.0;  ///< then of one half way back
  double all_ms = 0.0;      ///< of all poses, linearisation and factorisation included
  double trace_sum = 0.0;   ///< of all poses: which results were timed
};

/// The graph is solved first, untimed.
/// @throws replay::Failure when the core refuses the graph or it is singular
CovarianceRun run_covariance(const PoseGraph& source, const pipeline::HeapWatch& heap);

}  // namespace unisim::bench
