// SPDX-License-Identifier: MIT
// A known lens: where each pixel of the ideal image lies in the image it gives.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "drivers/geometric/geometric.h"

namespace unisim::geometric {

/// Camera of a calibration, in pixels of the frames at hand.
struct Lens {
  double focal_x = 0;  ///< 0: not known
  double focal_y = 0;
  cv::Point2d principal;
  int32_t model = UNISIM_DISTORTION_UNKNOWN;
  cv::Mat coefficients;  ///< 1 x 8 or, of a fisheye, 1 x 4

  double focal() const;
};

/// @return an empty string, or why the calibration in `config` is not of frames of this size
std::string lens_of(const unisim_geometric_config& config, const cv::Size& size, Lens* out);

/// Fills CV_32F maps. A place outside the image says that the lens does not see there: also beyond
/// the angle at which its polynomial turns back, where it means nothing.
void map_lens(const Lens& lens, const cv::Size& size, cv::Mat* x, cv::Mat* y);

}  // namespace unisim::geometric
