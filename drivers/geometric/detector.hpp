// SPDX-License-Identifier: MIT
// Finds new features where there are no tracks.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

#include "drivers/geometric/tracks.hpp"

namespace unisim::geometric {

class Detector {
 public:
  /// Corners (FAST) of `gray`, best response first, at least `spacing` pixels from every track and
  /// from each other, at most `wanted`. The result lives until the next call.
  /// @param mask set where no corner may be; those around tracks and corners are set in it
  const std::vector<cv::Point2f>& run(const cv::Mat& gray, const Tracks& tracks, int wanted,
                                      int spacing, cv::Mat* mask);

 private:
  std::vector<cv::KeyPoint> corners_;
  std::vector<cv::Point2f> found_;
};

}  // namespace unisim::geometric
