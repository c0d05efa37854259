// SPDX-License-Identifier: MIT
// What a session is made with, and the sizes that follow from it.
#include "core/session/session_config.hpp"

#include <algorithm>

namespace unisim {
namespace {

int32_t ceil_div(int32_t a, int32_t b) { return (a + b - 1) / b; }

/// Windows cut from max_keyframes: the full ones and one shorter at the end.
int32_t windows_of(const SessionConfig& config) {
  if (config.max_submaps > 0) return config.max_submaps;
  const int32_t step = config.window_size - config.window_overlap;
  return std::max(0, config.max_keyframes - config.window_size) / step + 2;
}

/// Blocks of the Cholesky factor. Keyframes come first and each sees the next one, the windows over
/// it and its loops; then submaps in time order see the next ones and the loops before them, at
/// worst all. Minimum degree needs about half of it (README.md).
int64_t factor_blocks(const SessionConfig& config, const SessionCapacity& capacity,
                      int32_t windows_over_keyframe) {
  const int64_t loops = config.max_loops;
  const int64_t keyframe_part =
      static_cast<int64_t>(capacity.keyframes) * (windows_over_keyframe + 3) +
      2 * loops * config.window_size;
  const int64_t chained =
      static_cast<int64_t>(capacity.windows) * (windows_over_keyframe + 1 + loops) +
      dense_factor_blocks(config.max_loops);
  const int64_t submap_part = std::min(chained, dense_factor_blocks(capacity.submaps));
  return std::min(keyframe_part + submap_part, dense_factor_blocks(capacity.graph.nodes));
}

/// Chain edges between windows and in place of loops; edges of loops to retired keyframes have two
/// measurements.
void add_skeleton(const SessionConfig& config, SessionCapacity* capacity) {
  const int32_t w = config.window_size;
  capacity->live_windows = config.window_submaps + 1;
  capacity->live_loops = config.max_loops;
  capacity->skeleton = capacity->windows;
  capacity->graph.chains = capacity->submaps;
  capacity->graph.edges += capacity->graph.chains;
  capacity->graph.measurements += capacity->graph.chains + config.max_loops * w;
  capacity->condenser.nodes = 2 * w + 2;
  capacity->condenser.edges = 5 * 2 * w + w + 1;
  capacity->condenser.measurements = 3 * 2 * w + 2 * w;
}

}  // namespace

SessionCapacity session_capacity(const SessionConfig& config) {
  const int32_t step = config.window_size - config.window_overlap;
  const int32_t windows_over_keyframe = ceil_div(config.window_size, step);
  SessionCapacity capacity;
  capacity.keyframes = config.max_keyframes;
  capacity.windows = windows_of(config);
  capacity.submaps = capacity.windows + config.max_loops;
  capacity.views = capacity.submaps * config.window_size;
  capacity.shared = capacity.windows * config.window_overlap;
  capacity.window_pairs =
      capacity.windows * std::min(2 * windows_over_keyframe, config.window_overlap);

  capacity.graph.nodes = capacity.keyframes + capacity.submaps;
  capacity.graph.edges =
      capacity.keyframes + 2 * capacity.views + capacity.shared + capacity.window_pairs;
  capacity.graph.measurements = capacity.keyframes + capacity.views + 2 * capacity.shared;

  if (config.window_submaps > 0) add_skeleton(config, &capacity);

  capacity.solver.nodes = capacity.graph.nodes;
  capacity.solver.edges = capacity.graph.edges;
  capacity.solver.pairs =
      capacity.keyframes + capacity.views + capacity.window_pairs + capacity.graph.chains;
  capacity.solver.factor_blocks =
      static_cast<int32_t>(factor_blocks(config, capacity, windows_over_keyframe));

  capacity.depth.keyframes = capacity.keyframes;
  capacity.depth.two_view_slots = std::min(capacity.keyframes, 2 * config.window_size + 2);
  capacity.depth.submap_slots = std::min(capacity.shared, 4 * config.window_overlap);
  capacity.depth.grid = config.grid;
  return capacity;
}

}  // namespace unisim
