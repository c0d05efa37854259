// SPDX-License-Identifier: MIT
// Raises the faint parts of an image, for the detector: corners of bare walls and dim corners are
// found too.
#pragma once

#include <opencv2/core.hpp>

namespace unisim::geometric {

/// The gain of a place follows from the contrast around it. So it changes where content moves past
/// other content, and bends a patch when it does: tracks measured on such an image drift (the way
/// of a driven camera is half as long again wrong, a rendered room's three times). Only corners are
/// looked for in it.
class LocalContrast {
 public:
  /// @param gray as the frame came  @param mean its local mean
  /// @return local mean removed, faint parts raised, until the next call
  const cv::Mat& run(const cv::Mat& gray, const cv::Mat& mean);

 private:
  void measure_gain(const cv::Mat& gray, const cv::Mat& mean);
  void apply_gain(const cv::Mat& gray, const cv::Mat& mean);

  cv::Mat difference_;  // gray from its local mean, without sign
  cv::Mat square_;
  cv::Mat variance_;   // of each cell of some pixels
  cv::Mat gain_;       // of each cell
  cv::Mat wide_gain_;  // of each column, for each row of cells
  cv::Mat raised_;
};

}  // namespace unisim::geometric
