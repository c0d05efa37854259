// SPDX-License-Identifier: MIT
// An image made ready for tracking: gray, free of exposure, faint parts raised, as a pyramid with
// derivatives.
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
  cv::Mat gray;                  ///< local mean removed, faint parts raised
  std::vector<cv::Mat> pyramid;  ///< alternating level, derivatives
};

/// Fills `out` from borrowed pixels. Subtracting the local mean takes out exposure jumps. Where the
/// contrast around a pixel is small it is raised: corners of bare walls and dim corners are found
/// and followed too, and a frame of less contrast than the one before loses none.
/// The members keep the buffers in between.
struct ImagePreparation {
  cv::Mat gray;
  cv::Mat mean;
  cv::Mat difference;  ///< gray from its local mean, without sign
  cv::Mat square;
  cv::Mat variance;   ///< of each cell of some pixels
  cv::Mat gain;       ///< of each cell
  cv::Mat wide_gain;  ///< of each column, for each row of cells
  void run(const unisim_image& image, PreparedImage* out);

 private:
  void measure_gain(int window);
  void apply_gain(cv::Mat* out) const;
};

/// Bytes of one PreparedImage of this size, derivatives included.
int64_t prepared_image_bytes(int width, int height);

}  // namespace unisim::geometric
