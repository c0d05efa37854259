// SPDX-License-Identifier: MIT
// From the image to the model's input and exactly back.
#include "drivers/onnx/image/framing.hpp"

#include <numeric>
#include <vector>

#include "drivers/onnx/image/preprocessor.hpp"
#include "tests/onnx/predictor_fixture.hpp"

using namespace unisim::onnx;
using unisim::testing::Image;

namespace {

Contract contract_of(Resize resize, int32_t width, int32_t height, int32_t multiple = 1) {
  Contract contract;
  contract.width = width;
  contract.height = height;
  contract.multiple = multiple;
  contract.resize = resize;
  contract.std = {1, 1, 1};
  return contract;
}

/// What the intrinsics of an image become in the input, worked out by hand here.
std::vector<float> input_intrinsics(const Framing& f, const Pinhole& image, double pixel_center) {
  const double cx = (image.cx + 0.5) * f.scale_x() - 0.5 + f.offset_x + pixel_center;
  const double cy = (image.cy + 0.5) * f.scale_y() - 0.5 + f.offset_y + pixel_center;
  return {static_cast<float>(image.fx * f.scale_x()),
          0,
          static_cast<float>(cx),
          0,
          static_cast<float>(image.fy * f.scale_y()),
          static_cast<float>(cy),
          0,
          0,
          1};
}

}  // namespace

TEST_CASE("crop fills the input and keeps the middle") {
  const Framing framing = make_framing(contract_of(Resize::kCrop, 224, 224), 640, 480);
  CHECK(framing.width == 299);
  CHECK(framing.height == 224);
  CHECK(framing.offset_x == -37);
  CHECK(framing.offset_y == 0);
}

TEST_CASE("pad keeps all of the image inside") {
  const Framing framing = make_framing(contract_of(Resize::kPad, 224, 224), 640, 480);
  CHECK(framing.width == 224);
  CHECK(framing.height == 168);
  CHECK(framing.offset_y == 28);
}

TEST_CASE("stretch gives each side a scale of its own") {
  const Framing framing = make_framing(contract_of(Resize::kStretch, 100, 100), 640, 480);
  CHECK(framing.scale_x() == 100.0 / 640);
  CHECK(framing.scale_y() == 100.0 / 480);
}

TEST_CASE("fit stretches what rounding explains and crops the rest") {
  // 640x480 to 504 wide is 378 high, a multiple of 14; 1280x720 is 283.5 high, made 280.
  CHECK(make_framing(contract_of(Resize::kFit, 504, 378, 14), 640, 480).height == 378);
  const Framing wide = make_framing(contract_of(Resize::kFit, 504, 280, 14), 1280, 720);
  CHECK(wide.width == 504);
  CHECK(wide.height == 280);
  const Framing other = make_framing(contract_of(Resize::kFit, 504, 378, 14), 1280, 720);
  CHECK(other.height == 378);
  CHECK(other.width == 672);
  CHECK(other.offset_x == -84);
}

TEST_CASE("intrinsics come back exactly, whatever the framing and the pixel centre") {
  const Pinhole truth = {525, 515, 319.5, 241.25};
  for (const Resize resize : {Resize::kStretch, Resize::kCrop, Resize::kPad, Resize::kFit}) {
    for (const double pixel_center : {0.0, 0.5}) {
      const Framing framing = make_framing(contract_of(resize, 154, 112, 14), 640, 480);
      const std::vector<float> K = input_intrinsics(framing, truth, pixel_center);
      const Pinhole found = image_intrinsics(framing, K.data(), pixel_center);
      CHECK(found.fx == Approx(truth.fx).epsilon(1e-6));
      CHECK(found.fy == Approx(truth.fy).epsilon(1e-6));
      CHECK(found.cx == Approx(truth.cx).margin(1e-3));
      CHECK(found.cy == Approx(truth.cy).margin(1e-3));
    }
  }
}

TEST_CASE("a map of the input lands where the image was") {
  // Same scale, so that input and image pixels are the same ones: 8x4 image in a 4x4 or 8x8 input.
  Image image(8, 4, 1);
  std::iota(image.pixels.begin(), image.pixels.end(), uint8_t{1});
  for (const Resize resize : {Resize::kCrop, Resize::kPad}) {
    const int32_t side = resize == Resize::kCrop ? 4 : 8;
    Preprocessor preprocessor(contract_of(resize, side, side), 8, 4);
    std::vector<float> input(static_cast<size_t>(3 * side * side));
    preprocessor.run(image.view, input.data());
    std::vector<float> back(32);
    to_image_grid(preprocessor.framing(), input.data(), -1, back.data());
    for (int32_t y = 0; y < 4; ++y) {
      for (int32_t x = 0; x < 8; ++x) {
        const bool seen = resize == Resize::kPad || (x >= 2 && x < 6);
        const float expected = seen ? static_cast<float>(image.at(x, y)) / 255.0f : -1.0f;
        CHECK(back[static_cast<size_t>(y * 8 + x)] == Approx(expected));
      }
    }
  }
}
