// SPDX-License-Identifier: MIT
// An image made ready for tracking: gray, free of exposure, as a pyramid with derivatives.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/image.h"

namespace unisim::geometric {

inline constexpr int kTrackWindow = 11;   ///< side of the tracked patch in pixels
inline constexpr int kPyramidLevels = 3;  ///< levels above full resolution
inline constexpr double kReferenceDiagonal =
    800.0;  ///< image diagonal that pixel thresholds refer to

/// Pyramid of one frame; buffers are reused from frame to frame.
struct PreparedImage {
  cv::Mat gray;                  ///< local mean removed
  std::vector<cv::Mat> pyramid;  ///< alternating level, derivatives
};

/// Fills `out` from borrowed pixels. Subtracting the local mean takes out exposure jumps.
/// `scratch` keeps the buffers in between.
struct ImagePreparation {
  cv::Mat gray;
  cv::Mat mean;
  void run(const unisim_image& image, PreparedImage* out);
};

/// Bytes of one PreparedImage of this size, derivatives included.
int64_t prepared_image_bytes(int width, int height);

}  // namespace unisim::geometric
