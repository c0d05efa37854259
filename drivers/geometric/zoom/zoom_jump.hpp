// SPDX-License-Identifier: MIT
// Notices a frame that is the one before, enlarged or reduced.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/image/prepared_image.hpp"

namespace unisim::geometric {

/// A zoom from one frame to the next (a phone changing lenses) leaves no track to measure it by.
/// Where the patches of the tracks suddenly fit badly, they are looked for again in the frame
/// before scaled about its centre by some factors.
class ZoomJump {
 public:
  void reserve(size_t points);
  /// @param points where tracks were in `previous`
  /// @param error  median difference of their patches in `current`, in gray values
  /// @return true when most of them are found at one scale that is far from 1
  bool see(const PreparedImage& previous, const PreparedImage& current,
           const std::vector<cv::Point2f>& points, double error);

 private:
  bool stands_out(double error);
  bool search(const PreparedImage& previous, const PreparedImage& current,
              const std::vector<cv::Point2f>& points);
  /// Points of scaled_ that are found in `current`, there and back. @return their number
  size_t match(const PreparedImage& current);

  double usual_error_ = -1;
  cv::Mat warped_;
  std::vector<cv::Mat> pyramid_;
  std::vector<cv::Point2f> scaled_;
  std::vector<cv::Point2f> found_;
  std::vector<cv::Point2f> back_;
  std::vector<uchar> forward_ok_;
  std::vector<uchar> back_ok_;
  std::vector<float> patch_error_;
};

}  // namespace unisim::geometric
