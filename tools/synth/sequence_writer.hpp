// SPDX-License-Identifier: MIT
// A folder in the layout of the TUM RGB-D benchmark, with the camera beside it.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/common/folder_lock.hpp"
#include "tools/synth/camera.hpp"

namespace unisim::synth {

/// Depth image values per metre, as in the TUM benchmark.
inline constexpr float kDepthFactor = 5000;

struct StampedPose {
  double time_s = 0;
  Eigen::Isometry3d T_world_cam = Eigen::Isometry3d::Identity();
};

class SequenceWriter {
 public:
  /// Make the folder and hold it. A folder that holds anything is refused, except that with `force`
  /// an earlier sequence of this program is removed. @throws tools::Failure
  SequenceWriter(const std::string& folder, bool force, bool jpeg);

  /// First file of a sequence: marks the folder as ours. @param text  of camera.toml
  void write_camera(const std::string& text) const;

  /// May be called from several threads, for different times. @throws tools::Failure
  void write_frame(double time_s, const cv::Mat& image, const cv::Mat& depth) const;

  /// Last files of a sequence: rgb.txt, depth.txt, associations.txt, groundtruth.txt.
  void write_lists(const std::vector<StampedPose>& poses) const;

 private:
  std::string image_name(double time_s) const;
  void write_text(const std::string& name, const std::string& text) const;

  std::string folder_;
  std::unique_ptr<tools::FolderLock> lock_;
  bool jpeg_;
};

}  // namespace unisim::synth
