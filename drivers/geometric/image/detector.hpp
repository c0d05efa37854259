// SPDX-License-Identifier: MIT
// Finds new features where there are no tracks.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

#include "drivers/geometric/image/tracks.hpp"

namespace unisim::geometric {

class Detector {
 public:
  /// Corners (FAST) of `gray`, best response first, at least `spacing` pixels from every track and
  /// from each other, at most `wanted`. Where these leave too few tracks, the cells that hold none
  /// are searched again for fainter ones. The result lives until the next call.
  /// @param mask set where no corner may be; those around tracks and corners are set in it
  const std::vector<cv::Point2f>& run(const cv::Mat& gray, const Tracks& tracks, int wanted,
                                      int spacing, cv::Mat* mask);

 private:
  void take_best(const cv::Size& size, int wanted, int spacing, cv::Mat* mask);
  void look_in_empty_cells(const cv::Mat& gray, const Tracks& tracks, int side);

  std::vector<cv::KeyPoint> corners_;
  std::vector<cv::KeyPoint> cell_corners_;
  std::vector<uint8_t> occupied_;  // by cell: has a track or a new corner
  std::vector<cv::Point2f> found_;
};

}  // namespace unisim::geometric
