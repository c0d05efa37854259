// SPDX-License-Identifier: MIT
// Notices a frame that is the one before, enlarged or reduced.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/image/two_way_flow.hpp"

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
  /// Fills scaled_ and found_ with the points that are found in `current`. @return their number
  size_t match(const PreparedImage& current);

  double usual_error_ = -1;
  cv::Mat warped_;
  std::vector<cv::Mat> pyramid_;
  TwoWayFlow flow_;
  std::vector<cv::Point2f> scaled_;  // what was followed both ways, in the scaled frame ...
  std::vector<cv::Point2f> found_;   // ... and in the present one
  std::vector<uchar> agree_;
};

}  // namespace unisim::geometric
