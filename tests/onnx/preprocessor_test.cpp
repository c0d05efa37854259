// SPDX-License-Identifier: MIT
// Pixels to the numbers a model takes.
#include "drivers/onnx/image/preprocessor.hpp"

#include "tests/onnx/predictor_fixture.hpp"

using namespace unisim::onnx;
using unisim::testing::colourful;
using unisim::testing::Image;

namespace {

Contract normalising(Resize resize, int32_t width, int32_t height) {
  Contract contract;
  contract.width = width;
  contract.height = height;
  contract.resize = resize;
  contract.mean = {0.1f, 0.2f, 0.3f};
  contract.std = {0.5f, 0.4f, 0.25f};
  contract.pad_value = 1;
  return contract;
}

std::vector<float> run(const Contract& contract, const Image& image) {
  Preprocessor preprocessor(contract, image.view.width, image.view.height);
  std::vector<float> planes(static_cast<size_t>(3 * contract.width * contract.height));
  preprocessor.run(image.view, planes.data());
  return planes;
}

}  // namespace

TEST_CASE("an image of the model's size is copied: RGB planes, mean and deviation") {
  Image image = colourful(6, 5, 1);
  const Contract contract = normalising(Resize::kFit, 6, 5);
  const std::vector<float> planes = run(contract, image);
  for (int32_t c = 0; c < 3; ++c) {
    const auto k = static_cast<size_t>(c);
    for (int32_t i = 0; i < 30; ++i) {
      const double value = image.at(i % 6, i / 6, 2 - c) / 255.0;
      const double expected = (value - double{contract.mean[k]}) / double{contract.std[k]};
      CHECK(planes[static_cast<size_t>(30 * c + i)] == Approx(expected).margin(1e-6));
    }
  }
}

TEST_CASE("a gray image fills the three planes") {
  Image image(2, 1, 1);
  image.at(0, 0) = 51;
  image.at(1, 0) = 255;
  const std::vector<float> planes = run(normalising(Resize::kStretch, 2, 1), image);
  CHECK(planes[0] == Approx((0.2 - 0.1) / 0.5).margin(1e-6));
  CHECK(planes[2] == Approx(0).margin(1e-6));
  CHECK(planes[5] == Approx((1 - 0.3) / 0.25).margin(1e-6));
}

TEST_CASE("padding has the value of the metadata") {
  Image image(4, 2, 1);
  const std::vector<float> planes = run(normalising(Resize::kPad, 4, 4), image);
  CHECK(planes[0] == Approx((1 - 0.1) / 0.5));
  CHECK(planes[4] == Approx((0 - 0.1) / 0.5));
  CHECK(planes[15] == Approx((1 - 0.1) / 0.5));
}

TEST_CASE("a ramp stays a ramp of the same extent, smaller and larger") {
  Image image(64, 4, 1);
  for (int32_t y = 0; y < 4; ++y) {
    for (int32_t x = 0; x < 64; ++x) image.at(x, y) = static_cast<uint8_t>(4 * x);
  }
  for (const int32_t width : {16, 128}) {
    const std::vector<float> planes = run(normalising(Resize::kStretch, width, 4), image);
    const double scale = 64.0 / width;
    for (int32_t x = width / 8; x < width - width / 8; ++x) {
      const double position = (x + 0.5) * scale - 0.5;
      const double expected = (4 * position / 255 - 0.1) / 0.5;
      CHECK(planes[static_cast<size_t>(x)] == Approx(expected).margin(1e-4));
    }
  }
}

TEST_CASE("shrinking sees every pixel: a checkerboard becomes its mean") {
  Image image(64, 64, 1);
  for (int32_t i = 0; i < 64 * 64; ++i) {
    image.at(i % 64, i / 64) = (i % 64 + i / 64) % 2 == 0 ? uint8_t{200} : uint8_t{100};
  }
  for (const float value : run(normalising(Resize::kStretch, 8, 8), image)) {
    const bool red = value == Approx((150.0 / 255 - 0.1) / 0.5).margin(0.01);
    const bool green = value == Approx((150.0 / 255 - 0.2) / 0.4).margin(0.01);
    const bool blue = value == Approx((150.0 / 255 - 0.3) / 0.25).margin(0.01);
    CHECK((red || green || blue));
  }
}
