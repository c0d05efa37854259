// SPDX-License-Identifier: MIT
// Tells a camera that only turned from one that moved.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace unisim::geometric {

/// Smallest median distance in pixels between `to` and `from` moved by a pure rotation, over all
/// rotations and focal lengths from 0.45 to 1.8 times `focal_px` (only `focal_px` itself when it is
/// known). Small: the pair has no parallax that could be told from rotation.
double rotation_residual_px(const std::vector<cv::Point2f>& from,
                            const std::vector<cv::Point2f>& to, const cv::Size& size,
                            double focal_px, bool focal_known);

}  // namespace unisim::geometric
