// SPDX-License-Identifier: MIT
// Relative pose error: motion over a fixed step, estimate against ground truth.
#include "tools/eval/rpe.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "drivers/common/format.hpp"

namespace unisim::eval {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPathTolerance = 0.1;     // of delta, for all pairs
constexpr double kTimeTolerance_s = 1e-3;  // rates such as 1/30 s do not add up to whole seconds

using Steps = std::vector<std::pair<size_t, size_t>>;

Pose relative(const Pose& a, const Pose& b) {
  return {b.time_s, a.R.transpose() * b.R, a.R.transpose() * (b.t - a.t)};
}

double rotation_angle_deg(const Eigen::Matrix3d& R) {
  const Eigen::Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(twice_sine.norm(), R.trace() - 1) * 180.0 / kPi;
}

// Path length or time since the first pose.
std::vector<double> progress(const std::vector<Pose>& poses, StepUnit unit) {
  std::vector<double> along(poses.size(), 0.0);
  for (size_t k = 1; k < poses.size(); ++k) {
    along[k] = unit == StepUnit::kSeconds ? poses[k].time_s - poses[0].time_s
                                          : along[k - 1] + (poses[k].t - poses[k - 1].t).norm();
  }
  return along;
}

Steps steps_by_count(size_t poses, const RpeStep& step) {
  Steps steps;
  if (step.delta >= static_cast<double>(poses)) return steps;
  const auto delta = static_cast<size_t>(step.delta);
  for (size_t k = 0; k + delta < poses; k += step.all_pairs ? 1 : delta)
    steps.emplace_back(k, k + delta);
  return steps;
}

// From where the last step ended to the first pose at least delta further. The path is summed anew
// from each start, as evo does, so that steps of exactly delta come out the same.
Steps consecutive_steps(const std::vector<Pose>& poses, const RpeStep& step) {
  Steps steps;
  const bool by_time = step.unit == StepUnit::kSeconds;
  const double enough = by_time ? step.delta - kTimeTolerance_s : step.delta;
  size_t start = 0;
  double path = 0;
  for (size_t k = 1; k < poses.size(); ++k) {
    path += (poses[k].t - poses[k - 1].t).norm();
    if ((by_time ? poses[k].time_s - poses[start].time_s : path) < enough) continue;
    steps.emplace_back(start, k);
    start = k;
    path = 0;
  }
  return steps;
}

// From every pose to the later one whose distance is nearest to delta.
Steps nearest_steps(const std::vector<Pose>& poses, const RpeStep& step) {
  const std::vector<double> along = progress(poses, step.unit);
  Steps steps;
  for (size_t i = 0; i + 1 < along.size(); ++i) {
    const double target = along[i] + step.delta;
    const auto later = along.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    auto best = std::lower_bound(later, along.end(), target);
    if (best == along.end() || (best != later && target - *(best - 1) <= *best - target)) --best;
    best = std::lower_bound(later, along.end(), *best);
    if (std::abs(*best - target) > kPathTolerance * step.delta) continue;
    steps.emplace_back(i, static_cast<size_t>(best - along.begin()));
  }
  return steps;
}

Steps find_steps(const std::vector<Pose>& poses, const RpeStep& step) {
  if (step.unit == StepUnit::kFrames) return steps_by_count(poses.size(), step);
  return step.all_pairs ? nearest_steps(poses, step) : consecutive_steps(poses, step);
}

void check(const RpeStep& step) {
  if (!(step.delta > 0) || !std::isfinite(step.delta))
    throw std::invalid_argument("a step must be above 0");
  if (step.unit == StepUnit::kFrames && step.delta != std::floor(step.delta)) {
    throw std::invalid_argument("a step in frames must be a whole number");
  }
}

}  // namespace

const char* step_unit_name(StepUnit unit) {
  return unit == StepUnit::kFrames ? "frames" : unit == StepUnit::kMetres ? "m" : "s";
}

Rpe relative_pose_error(const Trajectory& ground_truth, const Trajectory& estimate,
                        Alignment alignment, double max_dt_s, const RpeStep& step) {
  check(step);
  if (step.unit == StepUnit::kSeconds && !estimate.has_times()) {
    throw ScoreError(ScoreError::Kind::kNoTimes, estimate.name + ": has frame numbers, not times");
  }
  const std::vector<IndexPair> pairs = associate(ground_truth, estimate, max_dt_s);
  std::vector<Pose> truth, aligned;
  std::vector<Eigen::Vector3d> from, to;
  for (const IndexPair& pair : pairs) {
    truth.push_back(ground_truth.poses[pair.ground_truth]);
    aligned.push_back(estimate.poses[pair.estimate]);
    from.push_back(aligned.back().t);
    to.push_back(truth.back().t);
  }
  Rpe rpe;
  rpe.associated = pairs.size();
  rpe.T_truth_estimate = align(from, to, alignment);
  for (Pose& pose : aligned) {
    pose.R = rpe.T_truth_estimate.R * pose.R;
    pose.t = rpe.T_truth_estimate * pose.t;
  }
  for (const auto& [i, j] : find_steps(aligned, step)) {
    const Pose error = relative(relative(truth[i], truth[j]), relative(aligned[i], aligned[j]));
    rpe.translation_error.push_back(error.t.norm());
    rpe.rotation_error_deg.push_back(rotation_angle_deg(error.R));
    rpe.time_s.push_back(aligned[j].time_s);
  }
  if (rpe.time_s.empty()) {
    throw ScoreError(ScoreError::Kind::kNoStep,
                     drivers::format("no step of %g %s in %zu associated poses", step.delta,
                                     step_unit_name(step.unit), pairs.size()));
  }
  rpe.translation = summarise(rpe.translation_error);
  rpe.rotation_deg = summarise(rpe.rotation_error_deg);
  return rpe;
}

}  // namespace unisim::eval
