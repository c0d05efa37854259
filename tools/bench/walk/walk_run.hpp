// SPDX-License-Identifier: MIT
// A simulated walk through a session: every prediction as it is asked for, one short optimisation
// for each submap and loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/pipeline/heap_watch.hpp"
#include "tools/bench/simulator/loops.hpp"
#include "tools/bench/simulator/world.hpp"
#include "tools/bench/walk/snapshot_run.hpp"
#include "unisim/unisim.h"

namespace unisim::bench {

struct WalkSettings {
  simulator::WorldKind world = simulator::WorldKind::kWalk;
  int32_t keyframes = 1000;
  uint64_t seed = 1;
  bool submaps = true;
  bool loops = true;
  double false_loops = 0.0;         ///< share of all loops, below 1
  int32_t iterations = 2;           ///< of the optimisation after a submap or loop
  int32_t window_submaps = 2;       ///< as in unisim_config; 0: the full batch
  int32_t skeleton_capacity = 128;  ///< as in unisim_config
  int32_t readable = 0;             ///< keyframes that a sliding window keeps; 0: all of the walk
  int32_t overlap = 2;              ///< keyframes that consecutive windows share
  int32_t preset = UNISIM_PRESET_CONSISTENT;
  uint32_t disabled_factors = 0;  ///< UNISIM_FACTOR_*
  double scale_noise =
      0.0;  ///< of the depth of a view as a whole, standard deviation of its logarithm
  double depth_noise = 0.0;  ///< of each pixel, relative standard deviation
  double holes = 0.0;        ///< share of pixels without depth
  bool batch = true;         ///< walk once more as a full batch, to compare with
};

/// Times are process CPU time [ms] of the call that takes the prediction and the optimisation.
struct WalkResult {
  int32_t keyframes = 0;
  int32_t submaps = 0;
  int32_t submaps_refused = 0;
  int32_t loops = 0;
  int32_t loops_refused = 0;
  int32_t loops_out_of_reach = 0;  ///< a place was no longer kept
  int32_t loop_suspensions = 0;
  int32_t loop_returns = 0;
  int32_t loops_dropped = 0;
  size_t arena_bytes = 0;
  size_t depth_bytes = 0;  ///< of them for depth maps
  int64_t heap_calls = 0;  ///< inside the library, after the session was made
  std::vector<double> update_ms;
  std::vector<double> loop_update_ms;
  SnapshotResult snapshot;      ///< of the map at the end
  double live_ate_m = 0.0;      ///< of the poses as they were first given out
  double ate_m = 0.0;           ///< RMSE of positions after Sim(3) alignment
  double ate_over_batch = 0.0;  ///< 1 for a full batch itself, 0 when not compared
};

/// @throws replay::Failure when the session refuses a call
WalkResult run_walk(const WalkSettings& settings, const pipeline::HeapWatch& heap);

}  // namespace unisim::bench
