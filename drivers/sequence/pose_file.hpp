// SPDX-License-Identifier: MIT
// Files of camera poses: TUM, KITTI and EuRoC, one pose per line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/source.h"

namespace unisim::sequence {

enum class PoseFormat {
  kAuto,   ///< by the look of the lines
  kTum,    ///< time tx ty tz qx qy qz qw; seconds
  kKitti,  ///< 3x4 matrix by rows, with or without the frame number before it
  kEuroc,  ///< time, px, py, pz, qw, qx, qy, qz, ...; nanoseconds, commas
};

const char* pose_format_name(PoseFormat format);

/// A pose as the file has it, no digit lost.
struct FilePose {
  int64_t timestamp_ns;  ///< KITTI: frame number in seconds
  double time_s;         ///< the same as the nearest double to the file's text
  double rotation[9];    ///< row-major; of KITTI as written, so orthonormal to its digits only
  double translation[3];
};

struct PoseFile {
  PoseFormat format = PoseFormat::kAuto;
  std::vector<FilePose> poses;  ///< in the file's order
  bool numbered = false;        ///< KITTI: each line has its frame number
  int64_t skipped = 0;  ///< lines left out: not finite, zero quaternion, wrong number of fields
};

/// Reads a whole file. @throws InputError when it cannot be read or no line is a pose
PoseFile read_pose_file(const std::string& path, PoseFormat format = PoseFormat::kAuto);

/// Pose with a unit quaternion.
unisim_stamped_pose to_stamped_pose(const FilePose& pose);

/// Twelve or sixteen numbers of a matrix by rows to a pose. @return false when one is not finite or
/// the 3x3 is not a rotation to 1e-2
bool pose_from_matrix(const double* rows, FilePose* pose);

}  // namespace unisim::sequence
