// SPDX-License-Identifier: MIT
// How far a run is from ground truth.
#include "tools/replay/scores.hpp"

#include <cstdio>
#include <vector>

#include "tools/common/failure.hpp"

namespace unisim::replay {
namespace {

constexpr double kMaxTimeDifferenceSeconds = 0.02;

eval::Trajectory estimate(const std::string& name, const std::vector<unisim_stamped_pose>& poses) {
  return eval::make_trajectory(name, poses.data(), static_cast<int64_t>(poses.size()));
}

/// Empty, or why no pose of the run has a partner in time.
std::string clock_problem(const eval::Trajectory& truth, const eval::Trajectory& run) {
  const double first = truth.poses.front().time_s;
  const double last = truth.poses.back().time_s;
  const double from = run.poses.front().time_s;
  const double to = run.poses.back().time_s;
  if (from <= last + kMaxTimeDifferenceSeconds && to >= first - kMaxTimeDifferenceSeconds)
    return {};
  char line[160];
  std::snprintf(
      line, sizeof line,
      " has times %.3f to %.3f s, the sequence %.3f to %.3f s: no score; give ground truth "
      "of the same clock",
      first, last, from, to);
  return truth.name + line;
}

}  // namespace

eval::Trajectory load_ground_truth(const std::string& path, unisim_source* source) {
  if (!path.empty()) {
    try {
      return eval::read_trajectory(path);
    } catch (const eval::InputError& error) {
      throw tools::Failure(tools::kExitInput, error.what());
    }
  }
  const unisim_stamped_pose* poses = nullptr;
  const int64_t count = source->ground_truth(source, &poses);
  if (count <= 0) return {};
  return eval::make_trajectory(source->ground_truth_path(source), poses, count);
}

Scores score(const eval::Trajectory& truth, const RunData& data) {
  Scores scores;
  if (truth.poses.empty()) return scores;
  const eval::Trajectory final_poses = estimate("trajectory.tum", data.trajectory);
  scores.problem = clock_problem(truth, final_poses);
  if (!scores.problem.empty()) return scores;
  try {
    scores.ate = eval::absolute_trajectory_error(truth, final_poses, eval::Alignment::kSim3,
                                                 kMaxTimeDifferenceSeconds);
    scores.rpe = eval::relative_pose_error(truth, final_poses, eval::Alignment::kSim3,
                                           kMaxTimeDifferenceSeconds, {});
    scores.live =
        eval::absolute_trajectory_error(truth, estimate("trajectory_live.tum", data.live),
                                        eval::Alignment::kSim3, kMaxTimeDifferenceSeconds);
  } catch (const eval::InputError& error) {
    scores.problem = error.what();
  }
  return scores;
}

}  // namespace unisim::replay
