// SPDX-License-Identifier: MIT
// Which poses of two trajectories belong together.
#include "tools/eval/association.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace unisim::eval {
namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();

bool before(const Pose& a, const Pose& b) { return a.time_s < b.time_s; }

// Of two equally near times the earlier wins.
size_t nearest_sorted(const std::vector<Pose>& poses, double time_s, double max_dt_s) {
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

size_t nearest_unsorted(const std::vector<Pose>& poses, double time_s, double max_dt_s) {
  const auto nearer = [time_s](const Pose& a, const Pose& b) {
    return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
  };
  const auto best = std::min_element(poses.begin(), poses.end(), nearer);
  return std::abs(best->time_s - time_s) <= max_dt_s ? static_cast<size_t>(best - poses.begin())
                                                     : kNone;
}

std::string time_range(const Trajectory& trajectory) {
  const auto [first, last] =
      std::minmax_element(trajectory.poses.begin(), trajectory.poses.end(), before);
  char text[120];
  std::snprintf(text, sizeof text,
                trajectory.has_times() ? " has times %.6f to %.6f s" : " has frames %.0f to %.0f",
                first->time_s, last->time_s);
  return trajectory.name + text;
}

[[noreturn]] void refuse(const Trajectory& ground_truth, const Trajectory& estimate,
                         const std::string& what, const std::string& advice) {
  throw InputError(what + ": " + time_range(ground_truth) + ", " + time_range(estimate) + ": " +
                   advice);
}

}  // namespace

std::vector<IndexPair> associate(const Trajectory& ground_truth, const Trajectory& estimate,
                                 double max_dt_s) {
  if (ground_truth.poses.empty() || estimate.poses.empty()) {
    throw InputError((estimate.poses.empty() ? estimate : ground_truth).name +
                     ": has no poses to compare");
  }
  if (ground_truth.has_times() != estimate.has_times()) {
    refuse(ground_truth, estimate, "frame numbers and times do not compare",
           "give both files with times or both as KITTI");
  }
  const bool estimate_longer = estimate.poses.size() > ground_truth.poses.size();
  const std::vector<Pose>& few = estimate_longer ? ground_truth.poses : estimate.poses;
  const std::vector<Pose>& many = estimate_longer ? estimate.poses : ground_truth.poses;
  std::vector<IndexPair> pairs;
  const bool sorted = std::is_sorted(many.begin(), many.end(), before);
  for (size_t k = 0; k < few.size(); ++k) {
    const double time_s = few[k].time_s;
    const size_t match =
        sorted ? nearest_sorted(many, time_s, max_dt_s) : nearest_unsorted(many, time_s, max_dt_s);
    if (match == kNone) continue;
    pairs.push_back(estimate_longer ? IndexPair{k, match} : IndexPair{match, k});
  }
  if (pairs.empty()) {
    char what[80];
    std::snprintf(what, sizeof what, "no poses within %g s of each other", max_dt_s);
    refuse(ground_truth, estimate, what, "give files with the same clock or a larger --max-dt");
  }
  return pairs;
}

}  // namespace unisim::eval
