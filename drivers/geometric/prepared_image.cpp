// SPDX-License-Identifier: MIT
// An image made ready for tracking: gray, free of exposure, as a pyramid with derivatives.
#include "drivers/geometric/prepared_image.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace unisim::geometric {

namespace {
constexpr int kMeanWindow = 31;
constexpr double kMiddleGray = 128.0;
}  // namespace

void ImagePreparation::run(const unisim_image& image, PreparedImage* out) {
  const int type = image.format == UNISIM_PIXEL_BGR8 ? CV_8UC3 : CV_8UC1;
  // cv::Mat has no read-only view; the pixels are only read.
  const cv::Mat pixels(image.height, image.width, type, const_cast<uint8_t*>(image.data),
                       static_cast<size_t>(image.stride));
  if (type == CV_8UC3) {
    cv::cvtColor(pixels, gray, cv::COLOR_BGR2GRAY);
  } else {
    pixels.copyTo(gray);
  }
  cv::boxFilter(gray, mean, -1, cv::Size(kMeanWindow, kMeanWindow));
  cv::addWeighted(gray, 1.0, mean, -1.0, kMiddleGray, out->gray);
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
