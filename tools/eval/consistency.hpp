// SPDX-License-Identifier: MIT
// How far poses can be believed: their errors over the standard deviations a run gives them.
#pragma once

#include <map>
#include <vector>

#include "tools/eval/ate.hpp"
#include "tools/eval/keyframe_table.hpp"

namespace unisim::eval {

/// Errors over their standard deviations.
struct Ratios {
  size_t count = 0;
  double beyond_3 = 0;  ///< share above 3
  double median = 0;
  double p95 = 0;  ///< not exceeded by 95 %
  double max = 0;
};

/// Errors of keyframes with one value of `confidence`.
struct ConfidenceErrors {
  size_t count = 0;
  double median = 0;  ///< unit of the truth
};

struct Consistency {
  Ratios position;
  Ratios rotation;
  size_t without_sigma = 0;  ///< compared keyframes whose standard deviation is not known
  size_t good = 0;           ///< compared keyframes said to be tracked well
  size_t good_far_off = 0;   ///< of these: error over ten times the median of their segment
  std::map<int64_t, ConfidenceErrors> by_confidence;
  size_t segments = 0;          ///< aligned, each by itself
  size_t segments_skipped = 0;  ///< too short, or without truth
};

/// Both are beside the other keyframes of a segment, so each segment is aligned by itself (Sim(3),
/// positions alone) and its standard deviations are those that the same alignment leaves: see
/// tools/replay/pose_sigmas.hpp. Rotations are compared as that alignment turns them, their mean
/// taken out. Of poses that are compared in part, the alignment is that of this part.
/// @param estimate final poses of the keyframes, times as in `claims`
/// @throws ScoreError when no segment can be aligned
Consistency consistency(const Trajectory& truth, const Trajectory& estimate,
                        const std::vector<KeyframeClaim>& claims, double max_dt_s);

}  // namespace unisim::eval
