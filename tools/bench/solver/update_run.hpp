// SPDX-License-Identifier: MIT
// A pose graph that arrives piece by piece, optimised after each submap as on a robot.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/pipeline/heap_watch.hpp"
#include "tools/bench/solver/pose_graph.hpp"

namespace unisim::bench {

struct UpdateSettings {
  std::string graph;
  int32_t from = 0;           ///< keyframes there are before an update counts
  int32_t iterations = 2;     ///< of each update
  double least_move = 1e-6;   ///< LmOptions::least_move; 0: everything anew each time
  double relinearize = 1e-2;  ///< LmOptions::relinearize
  bool json = false;
};

/// Times are process CPU time [ms] of the optimisation that follows the arrival of a submap.
struct UpdateRun {
  int32_t keyframes = 0;
  int64_t heap_calls = 0;
  std::vector<double> update_ms;
  std::vector<double> loop_update_ms;  ///< of submaps that join places far apart in time
  double cost = 0.0;                   ///< at the end, as the updates left it
  double batch_cost = 0.0;             ///< and after optimising all of it to convergence
};

/// Nodes arrive in the order of the file, an edge with the later of its nodes; a new node starts
/// where the file's initial guess puts it relative to the keyframe before it.
/// @throws replay::Failure when the core refuses the graph
UpdateRun run_updates(const PoseGraph& source, const UpdateSettings& settings,
                      const pipeline::HeapWatch& heap);

}  // namespace unisim::bench
