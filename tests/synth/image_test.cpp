// SPDX-License-Identifier: MIT
// Filtering of textures and the sensor's exposure and noise.
#include "tests/support/catch.hpp"
#include "tools/synth/sensor.hpp"
#include "tools/synth/texture.hpp"

namespace {

using namespace unisim::synth;

Canvas checkerboard() {
  Canvas canvas(1, 1, 1.0 / 64);
  canvas.fill([](double x, double y) -> Color {
    const bool white = (static_cast<int>(x * 64) + static_cast<int>(y * 64)) % 2 == 0;
    return Color::Constant(white ? 200.0f : 100.0f);
  });
  return canvas;
}

}  // namespace

TEST_CASE("a pixel wider than the pattern sees its mean, so nothing flickers") {
  const Texture texture(checkerboard());
  for (float s = 0.3f; s < 0.7f; s += 0.013f) {
    const float pixel = 4.0f / 64;
    CHECK(texture.sample({s, 0.5f, pixel, 0, 0, pixel})[0] == Approx(150).margin(1));
  }
}

TEST_CASE("a pixel smaller than a texel sees the texel") {
  const Texture texture(checkerboard());
  const float pixel = 0.01f / 64;
  CHECK(texture.sample({10.5f / 64, 20.5f / 64, pixel, 0, 0, pixel})[0] == Approx(200));
  CHECK(texture.sample({11.5f / 64, 20.5f / 64, pixel, 0, 0, pixel})[1] == Approx(100));
}

TEST_CASE("a grazing view keeps the detail across it") {
  Canvas canvas(1, 1, 1.0 / 64);
  canvas.fill([](double x, double) -> Color {
    return Color::Constant(static_cast<int>(x * 64) % 16 < 8 ? 200.0f : 100.0f);
  });
  const Texture texture(canvas);
  const float narrow = 1.0f / 64;
  CHECK(texture.sample({4.0f / 64, 0.5f, narrow, 0, 0, 6 * narrow})[0] > 180);
}

TEST_CASE("noise has no mean and the stated size") {
  const Camera camera{200, 200, 160, 0};
  const ColorImage gray(40000, Color::Constant(128));
  SensorOptions options;
  options.noise = true;
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(expose(gray, camera, 1, options, 7), mean, sigma);
  CHECK(mean[0] == Approx(128).margin(0.1));
  CHECK(sigma[1] == Approx(std::sqrt(1.5 * 1.5 + 9 * 128.0 / 255)).epsilon(0.05));
}

TEST_CASE("exposure jumps between 0.7 and 1.3 and stays for half a second at least") {
  SensorOptions options;
  CHECK(exposure_gain(options, 100) == 1);
  options.exposure_jumps = true;
  int jumps = 0;
  for (int frame = 1; frame < 300; ++frame) {
    const double gain = exposure_gain(options, frame);
    CHECK(gain >= 0.7);
    CHECK(gain <= 1.3);
    jumps += gain != exposure_gain(options, frame - 1) ? 1 : 0;
  }
  CHECK(jumps >= 4);
  CHECK(jumps <= 20);
}

TEST_CASE("depth out of range of 16 bits is written as none") {
  const Camera camera{2, 1, 2, 0};
  const cv::Mat depth = encode_depth({1.5f, 14.0f}, camera, 5000);
  CHECK(depth.at<uint16_t>(0, 0) == 7500);
  CHECK(depth.at<uint16_t>(0, 1) == 0);
}
