// SPDX-License-Identifier: MIT
// Where an image lies in a model's input, and back.
#pragma once

#include <cstdint>

#include "drivers/onnx/model/contract.hpp"

namespace unisim::onnx {

/// The image is resized to `width` x `height` pixels and put at a whole offset into the input; what
/// lies outside the input is cut off, input without image is padding. Offsets are whole and each
/// axis has the scale of its own rounded size, so that the way back is exact.
///   stretch  each side by itself
///   crop     one scale, the input is filled, the middle is kept
///   pad      one scale, all of the image is inside, in the middle
///   fit      stretch where the shapes differ by no more than rounding the sides to unisim.multiple
///            explains, crop otherwise
struct Framing {
  int32_t image_width = 0;
  int32_t image_height = 0;
  int32_t width = 0;  ///< of the resized image
  int32_t height = 0;
  int32_t offset_x = 0;  ///< of its first column in the input; negative: cut off
  int32_t offset_y = 0;
  int32_t input_width = 0;
  int32_t input_height = 0;

  double scale_x() const { return static_cast<double>(width) / image_width; }
  double scale_y() const { return static_cast<double>(height) / image_height; }
};

Framing make_framing(const Contract& contract, int32_t image_width, int32_t image_height);

/// Intrinsics of the image, pixel centres at whole numbers.
struct Pinhole {
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
};

/// @param K 3x3 row-major, pixels of the model's input
/// @param pixel_center coordinate of its first pixel's centre
Pinhole image_intrinsics(const Framing& framing, const float* K, double pixel_center);

/// A map of the input (depth, confidence) to one of the whole image in the resized size.
/// @param[in]  input input_height x input_width
/// @param[out] image height x width; `outside` where the model did not see
void to_image_grid(const Framing& framing, const float* input, float outside, float* image);

}  // namespace unisim::onnx
