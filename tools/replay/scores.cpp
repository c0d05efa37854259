// SPDX-License-Identifier: MIT
// How far a run is from ground truth.
#include "tools/replay/scores.hpp"

#include <map>
#include <vector>

#include "drivers/common/format.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/score_poses.hpp"

namespace unisim::replay {
namespace {

eval::Trajectory estimate(const std::string& name, const std::vector<unisim_stamped_pose>& poses) {
  return eval::make_trajectory(name, poses.data(), static_cast<int64_t>(poses.size()));
}

void check_times(const eval::Trajectory& truth) {
  if (truth.has_times()) return;
  throw eval::InputError(truth.name +
                         ": matrices without times: give ground truth in TUM format (time tx ty tz "
                         "qx qy qz qw)");
}

/// Empty, or why no pose of the run has a partner in time.
std::string clock_problem(const eval::Trajectory& truth, const eval::Trajectory& run) {
  const double first = truth.poses.front().time_s;
  const double last = truth.poses.back().time_s;
  const double from = run.poses.front().time_s;
  const double to = run.poses.back().time_s;
  if (from <= last + kMaxTimeDifferenceSeconds && to >= first - kMaxTimeDifferenceSeconds)
    return {};
  return truth.name +
         drivers::format(
             " has times %.3f to %.3f s, the sequence %.3f to %.3f s: no score; give ground truth "
             "of the same clock",
             first, last, from, to);
}

eval::Ate ate_of(const ScorePoses& poses) {
  return eval::absolute_trajectory_error(poses.truth, poses.estimate, eval::Alignment::kSim3,
                                         kMaxTimeDifferenceSeconds);
}

std::string problem_of(const eval::Trajectory& truth, const eval::InputError& error,
                       const RunData& data, const char* what) {
  std::string line = truth.name + ": no score" + what + ": " + error.what();
  const auto* reason = dynamic_cast<const eval::ScoreError*>(&error);
  const bool few = reason != nullptr && reason->kind() != eval::ScoreError::Kind::kStill;
  if (few && data.frames.empty()) line += "; with --every-frame all frames are compared";
  return line;
}

void score_final(const eval::Trajectory& truth, const eval::Trajectory& keyframes,
                 const RunData& data, Scores* scores) {
  const ScorePoses poses =
      choose_poses(truth, keyframes, "keyframes", estimate("trajectory_frames.tum", data.frames));
  try {
    scores->ate = ate_of(poses);
    scores->poses = poses.what;
    scores->rpe = eval::relative_pose_error(poses.truth, poses.estimate, eval::Alignment::kSim3,
                                            kMaxTimeDifferenceSeconds, {});
  } catch (const eval::InputError& error) {
    scores->problem = problem_of(truth, error, data, "");
  }
}

void score_live(const eval::Trajectory& truth, const RunData& data, Scores* scores) {
  const eval::Trajectory live = estimate("trajectory_live.tum", data.live);
  const ScorePoses poses = choose_poses(truth, live, "live poses", {});
  try {
    scores->live = ate_of(poses);
    scores->live_poses = poses.what;
  } catch (const eval::InputError& error) {
    scores->problem = problem_of(truth, error, data, " of the live poses");
  }
}

std::optional<double> segment_error(const eval::Trajectory& truth,
                                    const std::vector<unisim_stamped_pose>& poses) {
  if (truth.poses.empty()) return {};
  try {
    return ate_of(choose_poses(truth, estimate("segment", poses), "", {})).error.rmse;
  } catch (const eval::InputError&) {
    return {};
  }
}

void score_segments(const eval::Trajectory& truth, const RunData& data, Scores* scores) {
  std::map<int32_t, std::vector<unisim_stamped_pose>> poses;
  std::map<int32_t, SegmentScore> segments;
  for (const KeyframeRow& row : data.keyframes) {
    if (row.pose.confidence == 0) continue;
    const int32_t id = row.pose.keyframe_id;
    SegmentScore& segment =
        segments.try_emplace(row.pose.segment, SegmentScore{id, id, 0, {}}).first->second;
    segment.last = id;
    ++segment.keyframes;
    poses[row.pose.segment].push_back({row.pose.timestamp_ns, row.pose.T_world_kf});
  }
  for (auto& [number, segment] : segments) {
    segment.ate_rmse_m = segment_error(truth, poses[number]);
    scores->segments.push_back(segment);
  }
}

}  // namespace

eval::Trajectory load_ground_truth(const std::string& path, unisim_source* source) {
  if (!path.empty()) {
    try {
      eval::Trajectory truth = eval::read_trajectory(path);
      check_times(truth);
      if (truth.skipped > 0) {
        truth.notes.push_back(path + ": " + std::to_string(truth.skipped) +
                              " lines are not a pose: left out");
      }
      return truth;
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
  score_segments(truth, data, &scores);
  if (truth.poses.empty()) return scores;
  const eval::Trajectory keyframes = estimate("trajectory.tum", data.trajectory);
  scores.problem = clock_problem(truth, keyframes);
  if (!scores.problem.empty()) return scores;
  score_final(truth, keyframes, data, &scores);
  if (scores.ate) score_live(truth, data, &scores);
  return scores;
}

}  // namespace unisim::replay
