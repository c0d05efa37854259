// SPDX-License-Identifier: MIT
// How an image is made ready for tracking and for the detector.
#include "drivers/geometric/image/prepared_image.hpp"

#include <cmath>

#include "drivers/geometric/image/local_contrast.hpp"
#include "tests/support/catch.hpp"

using unisim::geometric::ImagePreparation;
using unisim::geometric::LocalContrast;
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

class Frames {
 public:
  /// The next frame, prepared.
  cv::Mat show(const cv::Mat& image) {
    PreparedImage out;
    preparation_.run({image.data, image.cols, image.rows, image.cols, UNISIM_PIXEL_GRAY8}, &out);
    return out.gray;
  }
  /// The same with its faint parts raised.
  cv::Mat raised(const cv::Mat& image) {
    show(image);
    return LocalContrast().run(preparation_.gray(), preparation_.mean()).clone();
  }

 private:
  ImagePreparation preparation_;
};

double contrast(const cv::Mat& image) {
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(image, mean, sigma);
  return sigma[0];
}

}  // namespace

TEST_CASE("the detector sees faint texture raised, but not without limit") {
  const cv::Mat faint = checks(90, 3);
  const double gain = contrast(Frames().raised(faint)) / contrast(faint);
  CHECK(gain > 2.5);
  CHECK(gain < 3.2);
}

TEST_CASE("the detector sees strong texture as it is") {
  const cv::Mat strong = checks(128, 50);
  CHECK(contrast(Frames().raised(strong)) == Approx(contrast(strong)).epsilon(0.1));
}

TEST_CASE("a patch is tracked on grey levels that do not follow what is beside it") {
  cv::Mat half_strong = checks(128, 6);
  checks(128, 60)
      .colRange(kWidth / 2 + 40, kWidth)
      .copyTo(half_strong.colRange(kWidth / 2 + 40, kWidth));
  const cv::Mat alone = Frames().show(checks(128, 6));
  const cv::Mat beside = Frames().show(half_strong);
  const cv::Rect near(kWidth / 2 - 24, 60, 40, 60);
  CHECK(contrast(beside(near)) == Approx(contrast(alone(near))).epsilon(0.02));
}

TEST_CASE("contrast that flickers is held steady") {
  Frames frames;
  const double full = contrast(frames.show(checks(150, 24)));
  CHECK(contrast(frames.show(checks(100, 12))) == Approx(full).epsilon(0.1));
  CHECK(contrast(frames.show(checks(150, 24))) == Approx(full).epsilon(0.1));
}

TEST_CASE("what a moving camera brings into sight changes no gain") {
  Frames frames;
  frames.show(checks(128, 40));
  for (int amplitude = 39; amplitude > 20; --amplitude) {
    const cv::Mat image = checks(128, amplitude);
    CHECK(contrast(frames.show(image)) == Approx(contrast(image)).epsilon(0.02));
  }
}

TEST_CASE("a bare wall stays bare") {
  const cv::Mat wall(kHeight, kWidth, CV_8UC1, cv::Scalar(200));
  CHECK(contrast(Frames().show(wall)) == 0.0);
  CHECK(contrast(Frames().raised(wall)) == 0.0);
}
