// SPDX-License-Identifier: MIT
// Trajectories for evaluation.
#include "tools/eval/trajectory.hpp"

#include <Eigen/Geometry>

#include "drivers/sequence/pose_file.hpp"

namespace unisim::eval {

Trajectory read_trajectory(const std::string& path) {
  const sequence::PoseFile file = sequence::read_pose_file(path);
  Trajectory trajectory{path, sequence::pose_format_name(file.format), {}, file.skipped};
  trajectory.poses.reserve(file.poses.size());
  for (const sequence::FilePose& pose : file.poses) {
    trajectory.poses.push_back(
        {pose.time_s, Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.rotation),
         Eigen::Map<const Eigen::Vector3d>(pose.translation)});
  }
  return trajectory;
}

Trajectory make_trajectory(const std::string& name, const unisim_stamped_pose* poses,
                           int64_t count) {
  Trajectory trajectory{name, "tum", {}, 0};
  for (int64_t k = 0; k < count; ++k) {
    const unisim_sim3& T = poses[k].T_world_cam;
    const Eigen::Quaterniond q(T.q[3], T.q[0], T.q[1], T.q[2]);
    const auto time_s = static_cast<long double>(poses[k].timestamp_ns) / 1e9L;
    trajectory.poses.push_back(
        {static_cast<double>(time_s), q.normalized().toRotationMatrix(), Eigen::Vector3d(T.t)});
  }
  return trajectory;
}

}  // namespace unisim::eval
