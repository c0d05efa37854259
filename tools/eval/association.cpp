// SPDX-License-Identifier: MIT
// Which poses of two trajectories belong together.
#include "tools/eval/association.hpp"

#include <algorithm>
#include <limits>

#include "drivers/common/format.hpp"

namespace unisim::eval {
namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();

// Of two equally near times the earlier wins.
size_t nearest(const std::vector<Pose>& poses, double time_s, double max_dt_s) {
  if (time_s < poses.front().time_s - max_dt_s || time_s > poses.back().time_s + max_dt_s)
    return kNone;
  const auto later = [](double time, const Pose& pose) { return time < pose.time_s; };
  const auto above = std::upper_bound(poses.begin(), poses.end(), time_s, later);
  const auto upper = std::min(static_cast<size_t>(above - poses.begin()), poses.size() - 1);
  const double to_upper = poses[upper].time_s - time_s;
  const double to_lower =
      upper > 0 ? time_s - poses[upper - 1].time_s : std::numeric_limits<double>::infinity();
  if (to_upper <= max_dt_s && to_upper < to_lower) return upper;
  return to_lower <= max_dt_s && to_lower <= to_upper ? upper - 1 : kNone;
}

std::string time_range(const Trajectory& trajectory) {
  return trajectory.name + drivers::format(trajectory.has_times() ? " has times %.6f to %.6f s"
                                                                  : " has frames %.0f to %.0f",
                                           trajectory.poses.front().time_s,
                                           trajectory.poses.back().time_s);
}

std::string ranges(const Trajectory& ground_truth, const Trajectory& estimate) {
  return time_range(ground_truth) + ", " + time_range(estimate);
}

std::string line_count(const Trajectory& trajectory) {
  return trajectory.name + " has " + std::to_string(trajectory.lines) + " lines";
}

// Poses are compared by what identifies them, never by where they stand in their file.
void check_identity(const Trajectory& ground_truth, const Trajectory& estimate) {
  if (ground_truth.has_times() != estimate.has_times()) {
    throw InputError("frame numbers and times do not compare: " + ranges(ground_truth, estimate) +
                     ": give both files with times or both as KITTI");
  }
  const std::string advice = ": give each matrix its frame number as a first column";
  if (ground_truth.by_line && estimate.by_line && ground_truth.lines != estimate.lines) {
    throw InputError("which line is which frame is not known: " + line_count(ground_truth) + ", " +
                     line_count(estimate) + advice + ", or files with a line for every frame");
  }
  if (ground_truth.by_line == estimate.by_line) return;
  const Trajectory& plain = ground_truth.by_line ? ground_truth : estimate;
  const Trajectory& numbered = ground_truth.by_line ? estimate : ground_truth;
  const double last = numbered.poses.back().time_s;
  if (last < static_cast<double>(plain.lines)) return;
  throw InputError("which line is which frame is not known: " + numbered.name +
                   drivers::format(" has frame %.0f, ", last) + line_count(plain) + advice);
}

}  // namespace

std::vector<IndexPair> associate(const Trajectory& ground_truth, const Trajectory& estimate,
                                 double max_dt_s) {
  if (ground_truth.poses.empty() || estimate.poses.empty()) {
    throw InputError((estimate.poses.empty() ? estimate : ground_truth).name +
                     ": has no poses to compare");
  }
  check_identity(ground_truth, estimate);
  const bool estimate_longer = estimate.poses.size() > ground_truth.poses.size();
  const std::vector<Pose>& few = estimate_longer ? ground_truth.poses : estimate.poses;
  const std::vector<Pose>& many = estimate_longer ? estimate.poses : ground_truth.poses;
  std::vector<IndexPair> pairs;
  for (size_t k = 0; k < few.size(); ++k) {
    const size_t match = nearest(many, few[k].time_s, max_dt_s);
    if (match == kNone) continue;
    pairs.push_back(estimate_longer ? IndexPair{k, match} : IndexPair{match, k});
  }
  if (pairs.empty()) {
    throw ScoreError(ScoreError::Kind::kNoPairs,
                     drivers::format("no poses within %g s of each other: ", max_dt_s) +
                         ranges(ground_truth, estimate));
  }
  return pairs;
}

const char* association_name(const Trajectory& ground_truth, const Trajectory& estimate) {
  if (ground_truth.has_times()) return "time";
  return ground_truth.by_line && estimate.by_line ? "line" : "frame number";
}

}  // namespace unisim::eval
