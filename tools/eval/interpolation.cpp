// SPDX-License-Identifier: MIT
// Poses of a trajectory at times it was not given at.
#include "tools/eval/interpolation.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace unisim::eval {
namespace {

Pose between(const Pose& a, const Pose& b, double time_s) {
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(a.R).slerp(share, Eigen::Quaterniond(b.R));
  return {time_s, turn.toRotationMatrix(), a.t + share * (b.t - a.t)};
}

}  // namespace

Trajectory interpolate(const Trajectory& trajectory, const Trajectory& asked, double max_gap_s) {
  Trajectory out = trajectory;
  out.poses.clear();
  const std::vector<Pose>& poses = trajectory.poses;
  size_t next = 0;
  for (const Pose& pose : asked.poses) {
    while (next < poses.size() && poses[next].time_s < pose.time_s) ++next;
    if (next == poses.size()) break;
    if (poses[next].time_s == pose.time_s) {
      out.poses.push_back(poses[next]);
    } else if (next > 0 && poses[next].time_s - poses[next - 1].time_s <= max_gap_s) {
      out.poses.push_back(between(poses[next - 1], poses[next], pose.time_s));
    }
  }
  return out;
}

double median_step_s(const Trajectory& trajectory) {
  std::vector<double> steps;
  for (size_t k = 1; k < trajectory.poses.size(); ++k) {
    steps.push_back(trajectory.poses[k].time_s - trajectory.poses[k - 1].time_s);
  }
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace unisim::eval
