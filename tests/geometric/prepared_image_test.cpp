// SPDX-License-Identifier: MIT
// How an image is made ready for tracking.
#include "drivers/geometric/image/prepared_image.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using unisim::geometric::ImagePreparation;
using unisim::geometric::PreparedImage;

namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// Checks of 8 pixels, `amplitude` grey levels above and below `level`.
cv::Mat checks(int level, int amplitude) {
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool bright = (x / 8 + y / 8) % 2 == 0;
      image.at<uint8_t>(y, x) = static_cast<uint8_t>(level + (bright ? amplitude : -amplitude));
    }
  }
  return image;
}

cv::Mat prepared(const cv::Mat& image) {
  PreparedImage out;
  ImagePreparation().run({image.data, image.cols, image.rows, image.cols, UNISIM_PIXEL_GRAY8},
                         &out);
  return out.gray;
}

double contrast(const cv::Mat& image) {
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(image, mean, sigma);
  return sigma[0];
}

}  // namespace

TEST_CASE("faint texture is raised, but not without limit") {
  const cv::Mat faint = checks(90, 3);
  const double gain = contrast(prepared(faint)) / contrast(faint);
  CHECK(gain > 2.5);
  CHECK(gain < 3.2);
}

TEST_CASE("strong texture keeps its contrast") {
  const cv::Mat strong = checks(128, 50);
  CHECK(contrast(prepared(strong)) == Approx(contrast(strong)).epsilon(0.1));
}

TEST_CASE("contrast lost from one frame to the next is given back") {
  const double full = contrast(prepared(checks(150, 24)));
  const double half = contrast(prepared(checks(100, 12)));
  CHECK(half > 0.75 * full);
}

TEST_CASE("a bare wall stays bare") {
  CHECK(contrast(prepared(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(200)))) == 0.0);
}
