// SPDX-License-Identifier: MIT
// From the pixels of an image to the numbers a model takes.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/image.h"
#include "drivers/onnx/image/axis_resampler.hpp"
#include "drivers/onnx/image/framing.hpp"
#include "drivers/onnx/model/contract.hpp"

namespace unisim::onnx {

/// For images of one size. Takes no memory after construction.
class Preprocessor {
 public:
  Preprocessor(const Contract& contract, int32_t image_width, int32_t image_height);

  /// @param image gray or BGR, of the size given above
  /// @param[out] planes 3 x input height x input width: R, G, B as (x/255 - mean)/std
  void run(const unisim_image& image, float* planes);

  const Framing& framing() const { return framing_; }
  int64_t bytes() const { return static_cast<int64_t>(rows_.size() * sizeof(float)); }

 private:
  void resample_row(const uint8_t* pixels, int32_t channels, float* out) const;

  Contract contract_;
  Framing framing_;
  AxisResampler columns_;
  AxisResampler lines_;
  int32_t left_ = 0;  // first and last (not included) input column with image
  int32_t right_ = 0;
  std::vector<float> rows_;  // all image rows, resampled in x: [row][channel B G R][column]
};

}  // namespace unisim::onnx
