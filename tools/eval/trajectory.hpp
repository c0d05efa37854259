// SPDX-License-Identifier: MIT
// Trajectories for evaluation.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/sequence/text_file.hpp"
#include "drivers/source.h"

namespace unisim::eval {

using sequence::InputError;

/// Camera-to-world pose at a time.
struct Pose {
  double time_s;
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
};

struct Trajectory {
  std::string name;         ///< file, for messages and protocols
  std::string format;       ///< "tum", "kitti", "euroc"
  std::vector<Pose> poses;  ///< by growing time, each time once
  int64_t skipped = 0;      ///< lines of the file that are not a pose
  int64_t lines = 0;        ///< of the file, those skipped too
  bool by_line = false;     ///< KITTI without frame numbers: the time is the number of the line
  std::vector<std::string> notes = {};  ///< what is odd about it, one line each with its name

  bool has_times() const { return format != "kitti"; }
};

/// Reads TUM, KITTI (3x4, with or without frame number) or EuRoC csv; KITTI poses get the frame
/// number as their time. Poses are sorted; of those with one time the first of the file counts.
/// @throws InputError
Trajectory read_trajectory(const std::string& path);

/// The same from memory, sorted in the same way.
Trajectory make_trajectory(const std::string& name, const unisim_stamped_pose* poses,
                           int64_t count);

}  // namespace unisim::eval
