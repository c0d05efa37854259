// SPDX-License-Identifier: MIT
// How alike the surroundings of two points are.
#pragma once

#include <opencv2/core.hpp>

namespace unisim::geometric {

/// Normalised cross-correlation of 13x13 pixels around the points, -1..1.
double correlation(const cv::Mat& a, const cv::Point2f& at_a, const cv::Mat& b,
                   const cv::Point2f& at_b);

}  // namespace unisim::geometric
