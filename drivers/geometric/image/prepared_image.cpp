// SPDX-License-Identifier: MIT
// An image made ready for tracking: gray, free of exposure, faint parts raised, as a pyramid with
// derivatives.
#include "drivers/geometric/image/prepared_image.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace unisim::geometric {

namespace {
// Pixels. They shrink with smaller images; in larger ones wider windows measured worse (a drive).
constexpr double kMeanWindow = 31;
constexpr double kContrastWindow = 63;
constexpr int kCell = 8;  // pixels: contrast changes slowly, one value for each cell will do
constexpr float kMiddleGray = 128.0F;
// Standard deviation that faint neighbourhoods are raised to, and that of noise, which is not.
constexpr double kContrast = 40.0;
constexpr double kNoise = 8.0;
// Strong ones are left as they are. Without the upper limit, noise of bare walls is followed.
constexpr double kMostGain = 3.0;

int odd_size(double window) { return std::max(3, 2 * static_cast<int>(window / 2) + 1); }
}  // namespace

void ImagePreparation::measure_gain(int window) {
  cv::absdiff(gray, mean, difference);
  cv::multiply(difference, difference, square, 1.0, CV_16U);
  const cv::Size cells((gray.cols + kCell - 1) / kCell, (gray.rows + kCell - 1) / kCell);
  cv::resize(square, variance, cells, 0, 0, cv::INTER_AREA);
  variance.convertTo(gain, CV_32F);
  cv::boxFilter(gain, gain, -1, cv::Size(window, window));
  cv::sqrt(gain, gain);
  for (int y = 0; y < gain.rows; ++y) {
    auto* row = gain.ptr<float>(y);
    for (int x = 0; x < gain.cols; ++x) {
      row[x] = static_cast<float>(std::clamp(kContrast / (row[x] + kNoise), 1.0, kMostGain));
    }
  }
  cv::resize(gain, wide_gain, cv::Size(gray.cols, cells.height), 0, 0, cv::INTER_LINEAR);
}

void ImagePreparation::apply_gain(cv::Mat* out) const {
  out->create(gray.size(), CV_8UC1);
  const int width = gray.cols;  // the bytes written might be it, for all the compiler knows
  const float step = static_cast<float>(wide_gain.rows) / static_cast<float>(gray.rows);
  for (int y = 0; y < gray.rows; ++y) {
    const float at = std::clamp((static_cast<float>(y) + 0.5F) * step - 0.5F, 0.0F,
                                static_cast<float>(wide_gain.rows - 1));
    const int above = static_cast<int>(at);
    const float share = at - static_cast<float>(above);
    const auto* upper = wide_gain.ptr<float>(above);
    const auto* lower = wide_gain.ptr<float>(std::min(above + 1, wide_gain.rows - 1));
    const auto* seen = gray.ptr<uint8_t>(y);
    const auto* around = mean.ptr<uint8_t>(y);
    auto* to = out->ptr<uint8_t>(y);
    for (int x = 0; x < width; ++x) {
      const float raise = upper[x] + share * (lower[x] - upper[x]);
      const float value = kMiddleGray + raise * static_cast<float>(seen[x] - around[x]);
      to[x] = static_cast<uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  }
}

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
  const double scale = std::min(1.0, std::hypot(gray.cols, gray.rows) / kReferenceDiagonal);
  const int window = odd_size(kMeanWindow * scale);
  cv::boxFilter(gray, mean, -1, cv::Size(window, window));
  measure_gain(odd_size(kContrastWindow * scale / kCell));
  apply_gain(&out->gray);
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
