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
    800.0;                                    ///< image diagonal that pixel thresholds refer to
inline constexpr float kMiddleGray = 128.0F;  ///< of an image without its local mean

/// Pyramid of one frame; buffers are reused from frame to frame.
struct PreparedImage {
  cv::Mat gray;                  ///< local mean removed, contrast as in the frames before
  std::vector<cv::Mat> pyramid;  ///< alternating level, derivatives
};

/// The side of a window of `pixels` in an image of this size: odd, smaller in small images.
int odd_window(double pixels, const cv::Size& image);

/// Fills PreparedImages from borrowed pixels, frame by frame. Subtracting the local mean takes out
/// jumps of exposure, one gain for the whole image those of contrast (flicker, gamma): patches are
/// compared grey level by grey level. The members keep the buffers in between.
class ImagePreparation {
 public:
  void run(const unisim_image& image, PreparedImage* out);
  const cv::Mat& gray() const { return gray_; }  ///< of the last run, as it came
  const cv::Mat& mean() const { return mean_; }  ///< its local mean

 private:
  double steady_gain();

  cv::Mat gray_;
  cv::Mat mean_;
  cv::Mat difference_;
  double log_contrast_ = 0;  // of the last frame
  double log_gain_ = 0;
  bool first_ = true;
};

/// Bytes of one PreparedImage of this size, derivatives included.
int64_t prepared_image_bytes(int width, int height);

}  // namespace unisim::geometric
