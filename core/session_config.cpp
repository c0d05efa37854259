// SPDX-License-Identifier: MIT
// What a session is made with, and the sizes that follow from it.
#include "core/session_config.hpp"

#include <algorithm>

#include "core/map/metric_scale.hpp"

namespace unisim {
namespace {

int32_t ceil_div(int32_t a, int32_t b) { return (a + b - 1) / b; }

int32_t windows_over_keyframe(const SessionConfig& config) {
  return ceil_div(config.window_size, config.window_size - config.window_overlap);
}

/// Windows cut from `keyframes`: the full ones and one shorter at the end.
int32_t windows_of(const SessionConfig& config, int32_t keyframes) {
  if (config.max_submaps > 0) return config.max_submaps;
  const int32_t step = config.window_size - config.window_overlap;
  return std::max<int32_t>(0, keyframes - config.window_size) / step + 2;
}

/// Blocks of the Cholesky factor. Keyframes come first and each sees the next one, the windows over
/// it and its loops; then submaps in time order see the next ones and the loops before them, at
/// worst all. Minimum degree needs about half of it (README.md).
int64_t factor_blocks(const SessionConfig& config, const SessionCapacity& capacity) {
  const int32_t over = windows_over_keyframe(config);
  const int64_t loops = config.max_loops;
  const int64_t keyframe_part =
      static_cast<int64_t>(capacity.keyframes) * (over + 3) + 2 * loops * config.window_size;
  const int64_t chained = static_cast<int64_t>(capacity.submaps.windows) * (over + 1 + loops) +
                          dense_factor_blocks(config.max_loops) + capacity.submaps.windows;
  const int64_t submap_part =
      std::min(chained, dense_factor_blocks(capacity.submaps.windows + capacity.submaps.loops));
  return std::min(keyframe_part + submap_part, dense_factor_blocks(capacity.graph.nodes));
}

/// Everything that is fed stays.
void size_batch(const SessionConfig& config, SessionCapacity* capacity) {
  const int32_t windows = windows_of(config, config.max_keyframes);
  capacity->keyframes = config.max_keyframes;
  capacity->live_nodes = capacity->keyframes;
  capacity->live_loops = config.max_loops;
  capacity->open_windows = windows;
  capacity->submaps = {windows, config.max_loops, windows + config.max_loops, config.window_size,
                       windows * config.window_overlap};
  capacity->window_pairs =
      windows * std::min(2 * windows_over_keyframe(config), config.window_overlap);
  const int32_t submaps = windows + config.max_loops;
  const int32_t views = submaps * config.window_size;
  capacity->graph.nodes = capacity->keyframes + submaps + kMostMetres;
  capacity->graph.edges =
      capacity->keyframes + 2 * views + capacity->submaps.shared + capacity->window_pairs + windows;
  capacity->graph.measurements = capacity->keyframes + views + 2 * capacity->submaps.shared;
  capacity->solver.pairs = capacity->keyframes + views + capacity->window_pairs + windows;
  capacity->solver.factor_blocks = static_cast<int32_t>(factor_blocks(config, *capacity));
}

/// Two windows and what lies between their centres.
GraphCapacity condenser_capacity(int32_t w) {
  GraphCapacity capacity;
  capacity.nodes = 2 * w + 2;
  capacity.edges = 5 * 2 * w + w + 1;
  capacity.measurements = 3 * 2 * w + 2 * w;
  return capacity;
}

/// Windows that may wait for their prediction before keyframes are closed without them.
constexpr int32_t kWaitingWindows = 8;
constexpr int32_t kMostLiveLoops = 12;
/// Loop edges per skeleton node: more of them add fill-in and next to no accuracy (README.md).
constexpr double kLoopEdgesPerNode = 1.5;
/// Factor blocks per skeleton node; where loops tangle more than that, the weakest give way.
constexpr int32_t kBlocksPerSkeletonNode = 24;

/// Of a window, what it holds; of the past, the skeleton and a ring.
void size_window(const SessionConfig& config, SessionCapacity* capacity) {
  const int32_t w = config.window_size;
  capacity->live_nodes = (config.window_submaps + kWaitingWindows) * w;
  capacity->keyframes = std::max(config.max_keyframes, capacity->live_nodes + w);
  capacity->open_windows = capacity->live_nodes / 2 + 1;
  const int32_t readable = windows_of(config, capacity->keyframes);
  capacity->skeleton = config.skeleton_capacity > 0 ? config.skeleton_capacity : readable;
  capacity->live_windows = config.window_submaps + 1;
  capacity->live_loops = std::min(config.max_loops, kMostLiveLoops);
  capacity->loop_edges =
      config.max_loops == 0 ? 0 : static_cast<int32_t>(kLoopEdgesPerNode * capacity->skeleton) + 1;
  capacity->merges = 2 * capacity->skeleton;
  const int32_t live = capacity->live_windows + 1 + capacity->live_loops;
  // A skeleton node is known by one of its windows, which has to stay.
  capacity->submaps = {readable + capacity->skeleton + capacity->live_windows + 1, config.max_loops,
                       live, w, capacity->live_windows * w};
  capacity->window_pairs =
      capacity->live_windows *
      std::min(2 * windows_over_keyframe(config), std::max<int32_t>(config.window_overlap, 1));

  const int32_t nodes = capacity->live_nodes + w;
  const int32_t views = live * w;
  const int32_t submaps = live + capacity->skeleton + 1;
  capacity->graph.nodes = nodes + submaps + kMostMetres;
  capacity->graph.chains = 2 * (capacity->skeleton + capacity->live_windows) + capacity->loop_edges;
  capacity->graph.edges = nodes + 2 * views + capacity->submaps.shared + capacity->window_pairs +
                          capacity->graph.chains + submaps;
  capacity->graph.measurements =
      nodes + 2 * views + 2 * capacity->submaps.shared + capacity->graph.chains;
  capacity->solver.pairs =
      nodes + views + capacity->window_pairs + capacity->graph.chains + submaps;
  const int64_t blocks = static_cast<int64_t>(nodes) * (windows_over_keyframe(config) + 3) +
                         2 * static_cast<int64_t>(views) + dense_factor_blocks(live) + submaps +
                         static_cast<int64_t>(capacity->skeleton) * kBlocksPerSkeletonNode;
  capacity->solver.factor_blocks =
      static_cast<int32_t>(std::min(blocks, dense_factor_blocks(capacity->graph.nodes)));
  capacity->condenser = condenser_capacity(w);
}

}  // namespace

SessionCapacity session_capacity(const SessionConfig& config) {
  SessionCapacity capacity;
  if (config.window_submaps > 0) {
    size_window(config, &capacity);
  } else {
    size_batch(config, &capacity);
  }
  capacity.solver.nodes = capacity.graph.nodes;
  capacity.solver.edges = capacity.graph.edges;
  capacity.depth.keyframes = capacity.keyframes;
  capacity.depth.two_view_slots = std::min(capacity.keyframes, 2 * config.window_size + 2);
  capacity.depth.submap_slots = std::min(capacity.submaps.shared, 4 * config.window_overlap);
  capacity.depth.grid = config.grid;
  return capacity;
}

}  // namespace unisim
