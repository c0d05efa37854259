// SPDX-License-Identifier: MIT
// Where an image lies in a model's input, and back.
#include "drivers/onnx/image/framing.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::onnx {
namespace {

int32_t rounded(double size) { return std::max(static_cast<int32_t>(std::lround(size)), 1); }

/// Do the sides differ by no more than both being rounded to the multiple?
bool is_rounding(const Contract& contract, int32_t image_width, int32_t image_height) {
  const double sx = static_cast<double>(contract.width) / image_width;
  const double sy = static_cast<double>(contract.height) / image_height;
  const double half = 0.5 * contract.multiple + 0.5;
  return std::abs(sx * image_height - contract.height) <= half ||
         std::abs(sy * image_width - contract.width) <= half;
}

}  // namespace

Framing make_framing(const Contract& contract, int32_t image_width, int32_t image_height) {
  Resize resize = contract.resize;
  if (resize == Resize::kFit) {
    resize = is_rounding(contract, image_width, image_height) ? Resize::kStretch : Resize::kCrop;
  }
  Framing framing;
  framing.image_width = image_width;
  framing.image_height = image_height;
  framing.input_width = framing.width = contract.width;
  framing.input_height = framing.height = contract.height;
  if (resize == Resize::kStretch) return framing;
  const double sx = static_cast<double>(contract.width) / image_width;
  const double sy = static_cast<double>(contract.height) / image_height;
  const double scale = resize == Resize::kCrop ? std::max(sx, sy) : std::min(sx, sy);
  framing.width = rounded(scale * image_width);
  framing.height = rounded(scale * image_height);
  framing.offset_x = (contract.width - framing.width) / 2;
  framing.offset_y = (contract.height - framing.height) / 2;
  return framing;
}

Pinhole image_intrinsics(const Framing& framing, const float* K, double pixel_center) {
  Pinhole pinhole;
  pinhole.fx = K[0] / framing.scale_x();
  pinhole.fy = K[4] / framing.scale_y();
  // Both grids divide the same extent, so that their pixel borders, not their centres, scale.
  pinhole.cx = (K[2] - pixel_center - framing.offset_x + 0.5) / framing.scale_x() - 0.5;
  pinhole.cy = (K[5] - pixel_center - framing.offset_y + 0.5) / framing.scale_y() - 0.5;
  return pinhole;
}

void to_image_grid(const Framing& framing, const float* input, float outside, float* image) {
  const int32_t first = std::max(-framing.offset_x, 0);
  const int32_t end = std::min(framing.width, framing.input_width - framing.offset_x);
  for (int32_t row = 0; row < framing.height; ++row) {
    float* const out = image + static_cast<int64_t>(row) * framing.width;
    const int32_t from = row + framing.offset_y;
    if (from < 0 || from >= framing.input_height) {
      std::fill(out, out + framing.width, outside);
      continue;
    }
    const float* const in = input + static_cast<int64_t>(from) * framing.input_width;
    std::fill(out, out + first, outside);
    std::copy(in + first + framing.offset_x, in + end + framing.offset_x, out + first);
    std::fill(out + end, out + framing.width, outside);
  }
}

}  // namespace unisim::onnx
