// SPDX-License-Identifier: MIT
// Raises the faint parts of an image, for the detector.
#include "drivers/geometric/image/local_contrast.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "drivers/geometric/image/prepared_image.hpp"

namespace unisim::geometric {

namespace {
// Pixels. It shrinks with smaller images; in larger ones a wider window measured worse (a drive).
constexpr double kContrastWindow = 63;
constexpr int kCell = 8;  // pixels: contrast changes slowly, one value for each cell will do
// Standard deviation that faint neighbourhoods are raised to, and that of noise, which is not.
constexpr double kContrast = 40.0;
constexpr double kNoise = 8.0;
// Strong ones are left as they are. Without the upper limit, noise of bare walls is followed.
constexpr double kMostGain = 3.0;
}  // namespace

void LocalContrast::measure_gain(const cv::Mat& gray, const cv::Mat& mean) {
  const int window = odd_window(kContrastWindow / kCell, gray.size());
  cv::absdiff(gray, mean, difference_);
  cv::multiply(difference_, difference_, square_, 1.0, CV_16U);
  const cv::Size cells((gray.cols + kCell - 1) / kCell, (gray.rows + kCell - 1) / kCell);
  cv::resize(square_, variance_, cells, 0, 0, cv::INTER_AREA);
  variance_.convertTo(gain_, CV_32F);
  cv::boxFilter(gain_, gain_, -1, cv::Size(window, window));
  cv::sqrt(gain_, gain_);
  for (int y = 0; y < gain_.rows; ++y) {
    auto* row = gain_.ptr<float>(y);
    for (int x = 0; x < gain_.cols; ++x) {
      row[x] = static_cast<float>(std::clamp(kContrast / (row[x] + kNoise), 1.0, kMostGain));
    }
  }
  cv::resize(gain_, wide_gain_, cv::Size(gray.cols, cells.height), 0, 0, cv::INTER_LINEAR);
}

void LocalContrast::apply_gain(const cv::Mat& gray, const cv::Mat& mean) {
  raised_.create(gray.size(), CV_8UC1);
  const int width = gray.cols;  // the bytes written might be it, for all the compiler knows
  const float step = static_cast<float>(wide_gain_.rows) / static_cast<float>(gray.rows);
  for (int y = 0; y < gray.rows; ++y) {
    const float at = std::clamp((static_cast<float>(y) + 0.5F) * step - 0.5F, 0.0F,
                                static_cast<float>(wide_gain_.rows - 1));
    const int above = static_cast<int>(at);
    const float share = at - static_cast<float>(above);
    const auto* upper = wide_gain_.ptr<float>(above);
    const auto* lower = wide_gain_.ptr<float>(std::min(above + 1, wide_gain_.rows - 1));
    const auto* seen = gray.ptr<uint8_t>(y);
    const auto* around = mean.ptr<uint8_t>(y);
    auto* to = raised_.ptr<uint8_t>(y);
    for (int x = 0; x < width; ++x) {
      const float raise = upper[x] + share * (lower[x] - upper[x]);
      const float value = kMiddleGray + raise * static_cast<float>(seen[x] - around[x]);
      to[x] = static_cast<uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  }
}

const cv::Mat& LocalContrast::run(const cv::Mat& gray, const cv::Mat& mean) {
  measure_gain(gray, mean);
  apply_gain(gray, mean);
  return raised_;
}

}  // namespace unisim::geometric
