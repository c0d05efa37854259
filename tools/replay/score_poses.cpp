// SPDX-License-Identifier: MIT
// Which poses of a run are compared with which of the ground truth.
#include "tools/replay/score_poses.hpp"

#include <algorithm>

#include "tools/eval/association.hpp"
#include "tools/eval/interpolation.hpp"

namespace unisim::replay {
namespace {

constexpr size_t kFewestPairs = 3;
// A hand's 1 m/s^2 bends a path by 3 cm within half a second.
constexpr double kLongestGapSeconds = 0.5;
constexpr double kStepsOfGap = 2;

// Poses in the time the other trajectory covers.
size_t count_within(const eval::Trajectory& trajectory, const eval::Trajectory& other) {
  const double from = other.poses.front().time_s - kMaxTimeDifferenceSeconds;
  const double to = other.poses.back().time_s + kMaxTimeDifferenceSeconds;
  return static_cast<size_t>(std::count_if(
      trajectory.poses.begin(), trajectory.poses.end(),
      [=](const eval::Pose& pose) { return pose.time_s >= from && pose.time_s <= to; }));
}

size_t count_pairs(const eval::Trajectory& truth, const eval::Trajectory& estimate) {
  try {
    return eval::associate(truth, estimate, kMaxTimeDifferenceSeconds).size();
  } catch (const eval::ScoreError&) {
    return 0;
  }
}

bool meets(const eval::Trajectory& truth, const eval::Trajectory& estimate) {
  if (estimate.poses.empty()) return false;
  const size_t possible = std::min(count_within(truth, estimate), count_within(estimate, truth));
  const size_t pairs = count_pairs(truth, estimate);
  return pairs >= kFewestPairs && 2 * pairs >= possible;
}

eval::Trajectory fill(const eval::Trajectory& dense, const eval::Trajectory& sparse) {
  const double gap = std::min(kStepsOfGap * eval::median_step_s(dense), kLongestGapSeconds);
  return eval::interpolate(dense, sparse, gap);
}

}  // namespace

ScorePoses choose_poses(const eval::Trajectory& truth, const eval::Trajectory& keyframes,
                        const std::string& name, const eval::Trajectory& frames) {
  const ScorePoses plain = {truth, keyframes, name};
  if (meets(truth, keyframes)) return plain;
  if (meets(truth, frames)) return {truth, frames, "all frames"};
  const bool all = !frames.poses.empty();
  const eval::Trajectory& run = all ? frames : keyframes;
  const std::string run_name = all ? "all frames" : name;
  ScorePoses filled;
  if (count_within(run, truth) >= count_within(truth, run)) {
    filled = {truth, fill(run, truth), run_name + ", interpolated at the times of ground truth"};
  } else {
    filled = {fill(truth, run), run, run_name + ", ground truth interpolated at their times"};
  }
  const size_t pairs = std::min(filled.truth.poses.size(), filled.estimate.poses.size());
  return pairs >= kFewestPairs && pairs > count_pairs(truth, keyframes) ? filled : plain;
}

}  // namespace unisim::replay
