// SPDX-License-Identifier: MIT
// Relative pose error: motion over a fixed step, estimate against ground truth.
#pragma once

#include <string>
#include <vector>

#include "tools/eval/alignment.hpp"
#include "tools/eval/association.hpp"
#include "tools/eval/statistics.hpp"
#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

enum class StepUnit { kFrames, kMetres, kSeconds };

const char* step_unit_name(StepUnit unit);

/// The step over which motion is compared.
struct RpeStep {
  double delta = 1;
  StepUnit unit = StepUnit::kFrames;
  bool all_pairs = false;  ///< from every pose, not only from where the last step ended
};

/// One entry per step.
struct Rpe {
  Statistics translation;  ///< unit of the ground truth
  Statistics rotation_deg;
  std::vector<double> translation_error;
  std::vector<double> rotation_error_deg;
  std::vector<double> time_s;  ///< of the estimate, where the step ends
  Similarity T_truth_estimate;
  size_t associated = 0;
};

/// Errors of E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q the truth and P the aligned estimate.
///
/// Steps as evo takes them: frames counts associated poses, metres is the path of the aligned
/// estimate (all_pairs: the nearest length, within 10 %). Seconds, which evo has not: the first
/// pose at least delta - 1 ms later.
/// @throws InputError as associate() and align(), and when no step fits; std::invalid_argument for
/// a delta that is not above 0 or, in frames, not whole
Rpe relative_pose_error(const Trajectory& ground_truth, const Trajectory& estimate,
                        Alignment alignment, double max_dt_s, const RpeStep& step);

}  // namespace unisim::eval
