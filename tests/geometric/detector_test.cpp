// SPDX-License-Identifier: MIT
// Where corners are looked for.
#include "drivers/geometric/image/detector.hpp"

#include <algorithm>
#include <vector>

#include "tests/support/catch.hpp"

using unisim::geometric::Detector;
using unisim::geometric::Tracks;

namespace {

constexpr int kSide = 240;
constexpr int kDotStep = 30;
constexpr int kSpacing = 12;

/// Dots on middle gray: `left` grey levels brighter in the left half, `right` in the right one. One
/// pixel of each stands out: of equal ones FAST takes none.
cv::Mat dots(int left, int right) {
  cv::Mat image(kSide, kSide, CV_8UC1, cv::Scalar(128));
  for (int y = kDotStep / 2; y < kSide; y += kDotStep) {
    for (int x = kDotStep / 2; x < kSide; x += kDotStep) {
      const int contrast = x < kSide / 2 ? left : right;
      image(cv::Rect(x, y, 3, 3)).setTo(128 + contrast - 1);
      image.at<uint8_t>(y + 1, x + 1) = static_cast<uint8_t>(128 + contrast);
    }
  }
  return image;
}

int count_right(const std::vector<cv::Point2f>& points) {
  return static_cast<int>(std::count_if(points.begin(), points.end(), [](const cv::Point2f& p) {
    return p.x > static_cast<float>(kSide) / 2;
  }));
}

std::vector<cv::Point2f> detect(const cv::Mat& image, const Tracks& tracks, int wanted) {
  Detector detector;
  cv::Mat mask(image.size(), CV_8UC1, cv::Scalar(0));
  return detector.run(image, tracks, wanted, kSpacing, &mask);
}

}  // namespace

TEST_CASE("faint corners are found where an image shows too few strong ones") {
  const std::vector<cv::Point2f> found = detect(dots(60, 9), Tracks(), 200);
  CHECK(count_right(found) >= 20);
  CHECK(static_cast<int>(found.size()) - count_right(found) >= 20);
}

TEST_CASE("faint corners are left alone where strong ones suffice") {
  CHECK(count_right(detect(dots(60, 9), Tracks(), 30)) == 0);
}

TEST_CASE("noise is not taken for corners") { CHECK(detect(dots(4, 4), Tracks(), 200).empty()); }

TEST_CASE("faint corners keep away from tracks") {
  Tracks tracks;
  for (int y = 2; y < kSide; y += kSpacing) {
    for (int x = 2; x < kSide / 2; x += kSpacing) {
      tracks.add(cv::Point2f(static_cast<float>(x), static_cast<float>(y)), {0.0F, 0.0F}, 0);
    }
  }
  const std::vector<cv::Point2f> found = detect(dots(9, 9), tracks, 400);
  CHECK(count_right(found) >= 20);
  CHECK(count_right(found) == static_cast<int>(found.size()));
}
