// SPDX-License-Identifier: MIT
// How far a run is from ground truth.
#include "tools/replay/scores.hpp"

#include <vector>

#include "tools/replay/failure.hpp"

namespace unisim::replay {
namespace {

constexpr double kMaxTimeDifference_s = 0.02;

eval::Trajectory estimate(const std::string& name, const std::vector<unisim_stamped_pose>& poses) {
  return eval::make_trajectory(name, poses.data(), static_cast<int64_t>(poses.size()));
}

}  // namespace

eval::Trajectory load_ground_truth(const std::string& path, unisim_source* source) {
  if (!path.empty()) {
    try {
      return eval::read_trajectory(path);
    } catch (const eval::InputError& error) {
      throw Failure(kExitInput, error.what());
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
  try {
    const eval::Trajectory final_poses = estimate("trajectory.tum", data.trajectory);
    scores.ate = eval::absolute_trajectory_error(truth, final_poses, eval::Alignment::kSim3,
                                                 kMaxTimeDifference_s);
    scores.rpe = eval::relative_pose_error(truth, final_poses, eval::Alignment::kSim3,
                                           kMaxTimeDifference_s, {});
    scores.live = eval::absolute_trajectory_error(truth, estimate("trajectory_live.tum", data.live),
                                                  eval::Alignment::kSim3, kMaxTimeDifference_s);
  } catch (const eval::InputError& error) {
    scores.problem = error.what();
  }
  return scores;
}

}  // namespace unisim::replay
