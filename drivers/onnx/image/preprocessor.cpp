// SPDX-License-Identifier: MIT
// Resizing, cutting or padding, and normalisation.
#include "drivers/onnx/image/preprocessor.hpp"

#include <algorithm>

namespace unisim::onnx {

Preprocessor::Preprocessor(const Contract& contract, int32_t image_width, int32_t image_height)
    : contract_(contract),
      framing_(make_framing(contract, image_width, image_height)),
      columns_(image_width, framing_.width),
      lines_(image_height, framing_.height),
      left_(std::max(framing_.offset_x, 0)),
      right_(std::min(framing_.offset_x + framing_.width, framing_.input_width)),
      rows_(static_cast<size_t>(image_height) * 3 * static_cast<size_t>(right_ - left_)) {}

void Preprocessor::resample_row(const uint8_t* pixels, int32_t channels, float* out) const {
  const int32_t width = right_ - left_;
  const int32_t middle = channels / 2;
  const int32_t last = channels - 1;
  for (int32_t x = 0; x < width; ++x) {
    const AxisResampler::Taps taps = columns_.taps(x + left_ - framing_.offset_x);
    const uint8_t* pixel = pixels + static_cast<int64_t>(taps.first) * channels;
    float sums[3] = {};
    for (int32_t k = 0; k < taps.count; ++k, pixel += channels) {
      const float weight = taps.weights[k];
      sums[0] += weight * static_cast<float>(pixel[0]);
      sums[1] += weight * static_cast<float>(pixel[middle]);
      sums[2] += weight * static_cast<float>(pixel[last]);
    }
    for (int32_t channel = 0; channel < 3; ++channel) out[channel * width + x] = sums[channel];
  }
}

void Preprocessor::run(const unisim_image& image, float* planes) {
  const int32_t width = right_ - left_;
  const int64_t row_floats = int64_t{3} * width;
  for (int32_t y = 0; y < image.height; ++y) {
    resample_row(image.data + static_cast<int64_t>(y) * image.stride, image.format,
                 rows_.data() + y * row_floats);
  }
  const int64_t plane = static_cast<int64_t>(framing_.input_height) * framing_.input_width;
  for (int32_t channel = 0; channel < 3; ++channel) {
    const auto c = static_cast<size_t>(channel);
    const float gain = 1.0f / (255.0f * contract_.std[c]);
    const float shift = -contract_.mean[c] / contract_.std[c];
    float* out = planes + channel * plane;
    std::fill(out, out + plane, contract_.pad_value * 255.0f * gain + shift);
    for (int32_t y = 0; y < framing_.input_height; ++y, out += framing_.input_width) {
      const int32_t line = y - framing_.offset_y;
      if (line < 0 || line >= framing_.height) continue;
      const AxisResampler::Taps taps = lines_.taps(line);
      std::fill(out + left_, out + right_, 0.0f);
      const float* row = rows_.data() + taps.first * row_floats + (2 - channel) * width;
      for (int32_t k = 0; k < taps.count; ++k, row += row_floats) {
        for (int32_t x = 0; x < width; ++x) out[left_ + x] += taps.weights[k] * row[x];
      }
      for (int32_t x = left_; x < right_; ++x) out[x] = out[x] * gain + shift;
    }
  }
}

}  // namespace unisim::onnx
