// SPDX-License-Identifier: MIT
// From the images of a calibrated camera to those of an ideal one.
#include "drivers/geometric/camera/ideal_view.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/common/image_mat.hpp"
#include "drivers/geometric/camera/lens.hpp"

namespace unisim::geometric {

namespace {

// Pixels. Corners are found no better than this: what moves less is not worth another pass.
constexpr double kSame = 0.02;

/// Largest distance of a map's places from their own pixels.
double largest_move(const cv::Mat& x, const cv::Mat& y) {
  double most = 0;
  for (int row = 0; row < x.rows; ++row) {
    for (int column = 0; column < x.cols; ++column) {
      const cv::Point2d place(static_cast<double>(x.at<float>(row, column)),
                              static_cast<double>(y.at<float>(row, column)));
      const double move = cv::norm(place - cv::Point2d(column, row));
      most = std::max(most, move);
    }
  }
  return most;
}

}  // namespace

std::string IdealView::open(const cv::Size& size, unisim_geometric_config* config) {
  Lens lens;
  std::string problem = lens_of(*config, size, &lens);
  if (!problem.empty()) return problem;
  config->focal_px = lens.focal();
  cv::Mat x;
  cv::Mat y;
  map_lens(lens, size, &x, &y);
  if (largest_move(x, y) < kSame) return {};
  cv::convertMaps(x, y, whole_, parts_, CV_16SC2);
  hide_outside(x, y, config);
  return {};
}

void IdealView::hide_outside(const cv::Mat& x, const cv::Mat& y, unisim_geometric_config* config) {
  const cv::Mat seen = config->mask.data != nullptr
                           ? drivers::image_mat(config->mask)
                           : cv::Mat(x.size(), CV_8UC1, cv::Scalar(255)).clone();
  cv::Mat mask;
  cv::remap(seen, mask, x, y, cv::INTER_NEAREST, cv::BORDER_CONSTANT, cv::Scalar(0));
  if (config->mask.data == nullptr && cv::countNonZero(mask) == static_cast<int>(mask.total())) {
    return;
  }
  mask_.assign(mask.begin<uint8_t>(), mask.end<uint8_t>());
  config->mask = {mask_.data(), mask.cols, mask.rows, mask.cols, UNISIM_PIXEL_GRAY8};
}

unisim_image IdealView::run(const unisim_image& image, bool gray) {
  cv::Mat pixels = drivers::image_mat(image);
  if (gray && image.format == UNISIM_PIXEL_BGR8) {
    cv::cvtColor(pixels, gray_, cv::COLOR_BGR2GRAY);
    pixels = gray_;
  }
  // Outside the image its edge goes on: an end in black would bend the local mean.
  cv::remap(pixels, ideal_, whole_, parts_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return {ideal_.data, ideal_.cols, ideal_.rows, static_cast<int32_t>(ideal_.step),
          ideal_.channels() == 3 ? UNISIM_PIXEL_BGR8 : UNISIM_PIXEL_GRAY8};
}

cv::Point2f IdealView::place_in_image(const cv::Point2f& ideal) const {
  if (!active()) return ideal;
  const int column = std::clamp(cvRound(ideal.x), 0, whole_.cols - 1);
  const int row = std::clamp(cvRound(ideal.y), 0, whole_.rows - 1);
  const auto whole = whole_.at<cv::Vec2s>(row, column);
  const int part = parts_.at<uint16_t>(row, column);
  const auto sub = [](int steps) {
    return static_cast<float>(steps) / static_cast<float>(cv::INTER_TAB_SIZE);
  };
  return {static_cast<float>(whole[0]) + sub(part % cv::INTER_TAB_SIZE) + ideal.x -
              static_cast<float>(column),
          static_cast<float>(whole[1]) + sub(part / cv::INTER_TAB_SIZE) + ideal.y -
              static_cast<float>(row)};
}

int64_t IdealView::bytes() const {
  // Two maps of 4 and 2 bytes a pixel, the mask, a gray image and one in colour.
  return active() ? 11 * static_cast<int64_t>(whole_.total()) : 0;
}

}  // namespace unisim::geometric
