// SPDX-License-Identifier: MIT
// An image made ready for tracking: gray, free of exposure, as a pyramid with derivatives.
#include "drivers/geometric/image/prepared_image.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "drivers/common/image_mat.hpp"

namespace unisim::geometric {

namespace {
constexpr double kMeanWindow = 31;  // pixels
// Contrast changes by no more than a few per cent of its own from frame to frame where a camera
// moves: only larger steps are taken for a change of light or exposure and undone. (Undoing all of
// them follows what comes into sight, and made small images worse.)
constexpr double kContrastStep = 0.05;  // of the log
// A gain is given back slowly: nothing else would, when the light has changed for good.
constexpr double kGainKept = 0.98;  // from frame to frame
// Grey levels, the noise of a sensor: the camera is covered. What comes after is no change of
// light.
constexpr double kDark = 2.0;
}  // namespace

int odd_window(double pixels, const cv::Size& image) {
  const double scale = std::min(1.0, std::hypot(image.width, image.height) / kReferenceDiagonal);
  return std::max(3, 2 * static_cast<int>(pixels * scale / 2) + 1);
}

double ImagePreparation::steady_gain() {
  const double square = cv::norm(gray_, mean_, cv::NORM_L2SQR) / static_cast<double>(gray_.total());
  if (square < kDark * kDark) {
    first_ = true;
    log_gain_ = 0;
    return 1;
  }
  const double log_contrast = 0.5 * std::log(std::max(1.0, square));
  const double step = first_ ? 0 : log_contrast - log_contrast_;
  log_contrast_ = log_contrast;
  first_ = false;
  log_gain_ *= kGainKept;
  if (std::abs(step) > kContrastStep) log_gain_ -= step;
  return std::exp(log_gain_);
}

void ImagePreparation::run(const unisim_image& image, PreparedImage* out) {
  const cv::Mat pixels = drivers::image_mat(image);
  if (pixels.type() == CV_8UC3) {
    cv::cvtColor(pixels, gray_, cv::COLOR_BGR2GRAY);
  } else {
    pixels.copyTo(gray_);
  }
  const int window = odd_window(kMeanWindow, gray_.size());
  cv::boxFilter(gray_, mean_, -1, cv::Size(window, window));
  cv::subtract(gray_, mean_, difference_, cv::noArray(), CV_16S);
  difference_.convertTo(out->gray, CV_8U, steady_gain(), kMiddleGray);
  cv::buildOpticalFlowPyramid(out->gray, out->pyramid, cv::Size(kTrackWindow, kTrackWindow),
                              kPyramidLevels, true);
}

int64_t prepared_image_bytes(int width, int height) {
  int64_t bytes = int64_t{width} * height;
  for (int level = 0; level <= kPyramidLevels; ++level) {
    const int64_t padded_width = (width >> level) + 2 * kTrackWindow + 1;
    const int64_t padded_height = (height >> level) + 2 * kTrackWindow + 1;
    bytes += padded_width * padded_height * 5;  // one byte of gray, two 16-bit derivatives
  }
  return bytes;
}

}  // namespace unisim::geometric
