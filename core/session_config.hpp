// SPDX-License-Identifier: MIT
// What a session is made with, and the sizes that follow from it.
#pragma once

#include <cstdint>
#include <limits>

#include "core/base/event_log.hpp"
#include "core/graph/edge.hpp"
#include "core/graph/graph.hpp"
#include "core/map/depth_book.hpp"
#include "core/map/submap_table.hpp"
#include "core/solve/solver_capacity.hpp"

namespace unisim {

inline constexpr int32_t kFactorKinds = 5;  ///< kinds made of predictions; not kChain
inline constexpr int32_t kMaxViews = 64;    ///< keyframes of one prediction

/// Ids are given once, from 0 on. When those of keyframes or of submaps are used up the session
/// takes no more of either and stays as it is. What lies behind is for sums of ids and lengths, and
/// for the submaps that close the keyframes that are there.
inline constexpr int32_t kLastId = std::numeric_limits<int32_t>::max() - 65536;

/// How measurements enter the graph; numbers of UNISIM_PRESET_*.
enum class Preset : int32_t {
  kConsistent = 0,  ///< depth ratios inside the pose edges, two-view depth of the pair before
  kPaper = 1        ///< scale 1 in pose edges, two-view depth of the pair after
};

/// Weight and use of one factor kind.
struct FactorSetting {
  double information = 1.0;  ///< > 0
  bool enabled = true;
};

/// Checked configuration; meaning and ranges as in unisim.h.
struct SessionConfig {
  Preset preset = Preset::kConsistent;
  int32_t window_size = 16;
  int32_t window_overlap = 2;
  int32_t max_keyframes = 1024;
  int32_t max_submaps = 0;
  int32_t max_loops = 64;
  GridSize grid = {80, 60};
  FactorSetting factors[kFactorKinds];  ///< by FactorKind
  double huber_delta = 1.0;
  double loop_delta = 0.1;
  double loop_gate = 0.4;
  double live_scale_exponent = 0.5;
  double confidence_drop = 0.25;
  double sigma_reference = 0.001;
  double sigma_gate = 0.005;
  double sigma_gate_loop = 0.002;
  double sigma_factor = 4.0;
  double scatter_gate = 0.13;
  int32_t lost_after = 3;
  int32_t max_iterations = 10;
  int32_t window_submaps = 0;
  int32_t skeleton_capacity = 128;
  int32_t first_keyframe_id = 0;  ///< for tests of where ids end
  int32_t first_submap_id = 0;
  LogSink log;

  const FactorSetting& factor(FactorKind kind) const { return factors[static_cast<int>(kind)]; }
  bool slides() const { return window_submaps > 0; }
  RobustKernel kernel(EdgeOrigin origin) const {
    if (origin == EdgeOrigin::kLoop) return {RobustKernelKind::kGemanMcClure, loop_delta};
    return {RobustKernelKind::kHuber, huber_delta};
  }
  EdgeWeight edge_weight(FactorKind kind, double multiplier, EdgeOrigin origin) const {
    return {factor(kind).information, multiplier, kernel(origin), origin};
  }
};

/// Every array length of a session. Of a sliding window none depends on how long it runs.
struct SessionCapacity {
  int32_t keyframes = 0;   ///< kept
  int32_t live_nodes = 0;  ///< keyframes in the graph; more than that are closed into the skeleton
  int32_t open_windows = 0;  ///< of the full batch: windows in all
  SubmapTableSize submaps;
  int32_t window_pairs = 0;  ///< pairs of submaps that share keyframes: scale edges
  int32_t live_windows = 0;  ///< windows with their keyframes in the graph, 0: all of them
  int32_t live_loops = 0;
  int32_t skeleton = 0;    ///< nodes that stay when a window has been added
  int32_t loop_edges = 0;  ///< condensed loops
  int32_t merges = 0;      ///< that wait to be offered
  GraphCapacity condenser;
  GraphCapacity graph;
  SolverCapacity solver;
  DepthBookSize depth;
};

/// Lengths that hold whatever is fed: within the configured numbers in the full batch, for ever in
/// a sliding window.
SessionCapacity session_capacity(const SessionConfig& config);

}  // namespace unisim
