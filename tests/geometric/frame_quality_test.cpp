// SPDX-License-Identifier: MIT
// Why a frame is of little use: each reason by itself, and none where nothing is wrong.
#include "drivers/geometric/image/frame_quality.hpp"

#include <opencv2/imgproc.hpp>

#include "drivers/predictor.h"
#include "tests/support/catch.hpp"

using unisim::geometric::FrameEvidence;
using unisim::geometric::FrameQuality;
using unisim::geometric::ImageMeasures;
using unisim::geometric::measure_image;

namespace {

constexpr int64_t kStepNs = 33333333;

/// Something to look at, each time a little different.
cv::Mat1b scene(int number) {
  cv::Mat1b image(120, 160, uint8_t{110});
  cv::RNG random(7);
  for (int k = 0; k < 120; ++k) {
    const cv::Point corner(random.uniform(-10, 160) + number, random.uniform(-10, 120));
    const cv::Size size(random.uniform(4, 24), random.uniform(4, 24));
    cv::rectangle(image, cv::Rect(corner, size), cv::Scalar(random.uniform(20, 220)), cv::FILLED);
  }
  return image;
}

cv::Mat1b noise(double mean, double sigma, int number) {
  cv::Mat1b image(120, 160);
  cv::RNG random(static_cast<uint64_t>(number) + 1);
  random.fill(image, cv::RNG::NORMAL, mean, sigma);
  return image;
}

/// A camera whose frames come one after the other.
class Camera {
 public:
  int32_t see(const cv::Mat1b& image, int64_t steps = 1, size_t tracks = 200) {
    time_ns_ += steps * kStepNs;
    return quality_.see({measure_image(image), time_ns_, tracks, true});
  }

  /// Frames with which nothing is wrong.
  void warm_up(int frames = 20) {
    for (int k = 0; k < frames; ++k) REQUIRE(see(scene(k)) == UNISIM_REASON_NONE);
  }

 private:
  FrameQuality quality_;
  int64_t time_ns_ = 0;
};

cv::Mat1b dimmed(const cv::Mat1b& image, double gain) {
  cv::Mat1b dim;
  image.convertTo(dim, CV_8U, gain);
  return dim;
}

cv::Mat1b blurred(const cv::Mat1b& image) {
  cv::Mat1b soft;
  cv::GaussianBlur(image, soft, {}, 6.0);
  return soft;
}

}  // namespace

TEST_CASE("measures of an image by hand") {
  cv::Mat1b image(16, 16, uint8_t{100});
  image(cv::Rect(8, 0, 8, 16)).setTo(uint8_t{255});
  const ImageMeasures measures = measure_image(image);
  // Columns 2 to 13 are measured: six dark, six bright; four of them beside the step.
  CHECK(measures.mean == Approx(177.5));
  CHECK(measures.contrast == Approx(77.5 * 77.5));
  CHECK(measures.detail == Approx(155.0 * 155.0 / 12));
  CHECK(measures.edges == Approx(4.0 / 12));
  CHECK(measures.clipped == Approx(0.5));
  CHECK(measures.print == measure_image(image.clone()).print);
  image(2, 5) = 101;
  CHECK(measures.print != measure_image(image).print);
}

TEST_CASE("each reason by itself, and none before and after") {
  Camera camera;
  camera.warm_up();
  CHECK(camera.see(noise(5, 1, 1)) == UNISIM_REASON_COVERED);
  CHECK(camera.see(noise(25, 2, 2)) == UNISIM_REASON_COVERED);  // a hand lets some light through
  CHECK(camera.see(scene(20)) == UNISIM_REASON_NONE);
  CHECK(camera.see(noise(180, 2, 3)) == UNISIM_REASON_TEXTURE);
  CHECK(camera.see(noise(300, 2, 4)) == UNISIM_REASON_EXPOSURE);
  CHECK(camera.see(blurred(scene(21))) == UNISIM_REASON_BLUR);
  CHECK(camera.see(scene(22)) == UNISIM_REASON_NONE);
  CHECK(camera.see(scene(22)) == UNISIM_REASON_DUPLICATE);
  CHECK(camera.see(scene(23), 30) == UNISIM_REASON_TIME_GAP);
  CHECK(camera.see(scene(24)) == UNISIM_REASON_NONE);
  CHECK(camera.see(scene(25), 1, 10) == UNISIM_REASON_TEXTURE);  // nothing of it can be followed
  CHECK(camera.see(scene(26)) == UNISIM_REASON_NONE);
}

TEST_CASE("a camera that is soft, dim or slow has no reason") {
  Camera soft;
  Camera dim;
  for (int k = 0; k < 40; ++k) {
    CHECK(soft.see(blurred(scene(k)), 12) == UNISIM_REASON_NONE);
    CHECK(dim.see(dimmed(scene(k), 0.3), 12) == UNISIM_REASON_NONE);
  }
}

TEST_CASE("frames that are missed now and then, flicker and a little blur are no reason") {
  Camera camera;
  camera.warm_up();
  for (int k = 20; k < 60; ++k) {
    cv::Mat1b image = scene(k);
    if (k % 3 == 0) cv::GaussianBlur(image, image, {}, 0.6);
    CHECK(camera.see(dimmed(image, k % 2 == 0 ? 0.7 : 1.1), k % 4 == 0 ? 3 : 1) ==
          UNISIM_REASON_NONE);
  }
}

TEST_CASE("the first frames are judged by what needs no comparison") {
  CHECK(Camera().see(noise(3, 1, 1)) == UNISIM_REASON_COVERED);
  CHECK(Camera().see(noise(300, 1, 1)) == UNISIM_REASON_EXPOSURE);
  CHECK(Camera().see(blurred(scene(0))) == UNISIM_REASON_NONE);
}

TEST_CASE("what goes on for long becomes usual") {
  Camera camera;
  camera.warm_up();
  for (int k = 0; k < FrameQuality::kPatience; ++k)
    CHECK(camera.see(blurred(scene(k))) == UNISIM_REASON_BLUR);
  camera.see(blurred(scene(1)));
  for (int k = 2; k < 20; ++k) CHECK(camera.see(blurred(scene(k))) == UNISIM_REASON_NONE);
  // A covered lens stays covered: it is judged against nothing.
  for (int k = 0; k < 3 * FrameQuality::kPatience; ++k)
    CHECK(camera.see(noise(5, 1, k)) == UNISIM_REASON_COVERED);
}
