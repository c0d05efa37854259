// SPDX-License-Identifier: MIT
// How far a run is from ground truth.
#pragma once

#include <optional>
#include <string>

#include "drivers/source.h"
#include "tools/eval/ate.hpp"
#include "tools/eval/rpe.hpp"
#include "tools/eval/trajectory.hpp"
#include "tools/replay/run_data.hpp"

namespace unisim::replay {

/// Reads `path`, or takes what the source carries when it is empty; no poses if there is neither.
/// Throws Failure (3).
eval::Trajectory load_ground_truth(const std::string& path, unisim_source* source);

/// Errors in metres, each trajectory aligned by itself by Sim(3), poses associated by time (at most
/// 0.02 s apart). What cannot be told is absent.
struct Scores {
  std::optional<eval::Ate> ate;   ///< keyframes, final poses; its alignment gives metres per unit
  std::optional<eval::Ate> live;  ///< poses as first given out
  std::optional<eval::Rpe> rpe;   ///< from each keyframe to the next, final poses
  std::string problem;            ///< one line: why there is ground truth but no score
};

Scores score(const eval::Trajectory& truth, const RunData& data);

}  // namespace unisim::replay
