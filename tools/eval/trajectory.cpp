// SPDX-License-Identifier: MIT
// Trajectories for evaluation.
#include "tools/eval/trajectory.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "drivers/common/stamp_text.hpp"
#include "drivers/sequence/pose_file.hpp"

namespace unisim::eval {
namespace {

bool before(const Pose& a, const Pose& b) { return a.time_s < b.time_s; }

void put_in_order(Trajectory* trajectory) {
  std::vector<Pose>& poses = trajectory->poses;
  const std::string what = trajectory->has_times() ? "time" : "frame number";
  if (!std::is_sorted(poses.begin(), poses.end(), before)) {
    std::stable_sort(poses.begin(), poses.end(), before);
    trajectory->notes.push_back(trajectory->name + ": not in the order of " + what + ": sorted");
  }
  const auto same = [](const Pose& a, const Pose& b) { return a.time_s == b.time_s; };
  const auto end = std::unique(poses.begin(), poses.end(), same);
  const auto repeats = static_cast<size_t>(poses.end() - end);
  poses.erase(end, poses.end());
  if (repeats == 0) return;
  trajectory->notes.push_back(trajectory->name + ": " + std::to_string(repeats) +
                              (repeats == 1 ? " pose has" : " poses have") + " the " + what +
                              " of another: the first of each is used");
}

}  // namespace

Trajectory read_trajectory(const std::string& path) {
  const sequence::PoseFile file = sequence::read_pose_file(path);
  Trajectory trajectory{path, sequence::pose_format_name(file.format), {}, file.skipped};
  trajectory.lines = static_cast<int64_t>(file.poses.size()) + file.skipped;
  trajectory.by_line = file.format == sequence::PoseFormat::kKitti && !file.numbered;
  trajectory.poses.reserve(file.poses.size());
  for (const sequence::FilePose& pose : file.poses) {
    trajectory.poses.push_back(
        {pose.time_s, Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.rotation),
         Eigen::Map<const Eigen::Vector3d>(pose.translation)});
  }
  put_in_order(&trajectory);
  return trajectory;
}

Trajectory make_trajectory(const std::string& name, const unisim_stamped_pose* poses,
                           int64_t count) {
  Trajectory trajectory{name, "tum", {}, 0};
  for (int64_t k = 0; k < count; ++k) {
    const unisim_sim3& T = poses[k].T_world_cam;
    const Eigen::Quaterniond q(T.q[3], T.q[0], T.q[1], T.q[2]);
    trajectory.poses.push_back({drivers::stamp_seconds(poses[k].timestamp_ns),
                                q.normalized().toRotationMatrix(), Eigen::Vector3d(T.t)});
  }
  put_in_order(&trajectory);
  return trajectory;
}

}  // namespace unisim::eval
