// SPDX-License-Identifier: MIT
// How far a run is from ground truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/source.h"
#include "tools/eval/ate.hpp"
#include "tools/eval/rpe.hpp"
#include "tools/eval/trajectory.hpp"
#include "tools/replay/run_data.hpp"

namespace unisim::replay {

/// Reads `path`, or takes what the source carries when it is empty; no poses if there is neither.
/// What is odd about it stands in its notes. Throws Failure (3).
eval::Trajectory load_ground_truth(const std::string& path, unisim_source* source);

/// Keyframes that have a common frame and scale, aligned by themselves.
struct SegmentScore {
  int32_t first;      ///< id of its first keyframe with a supported pose
  int32_t last;       ///< of its last one
  int32_t keyframes;  ///< their number
  std::optional<double> ate_rmse_m;
};

/// Errors in metres, each trajectory aligned by itself by Sim(3), poses as choose_poses() takes
/// them. What cannot be told is absent.
struct Scores {
  std::optional<eval::Ate> ate;           ///< final poses; its alignment gives metres per unit
  std::optional<eval::Ate> live;          ///< poses as first given out
  std::optional<eval::Rpe> rpe;           ///< from each compared pose to the next, final poses
  std::string poses = "keyframes";        ///< which poses are compared
  std::string live_poses = "live poses";  ///< the same of `live`
  std::vector<SegmentScore> segments;     ///< in the order of time, also without ground truth
  std::string problem;                    ///< one line: why there is ground truth but no score
};

Scores score(const eval::Trajectory& truth, const RunData& data);

}  // namespace unisim::replay
