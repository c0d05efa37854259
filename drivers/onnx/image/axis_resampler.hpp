// SPDX-License-Identifier: MIT
// Weights that resample one axis: linear where it grows, a tent over what a pixel covers where it
// shrinks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace unisim::onnx {

/// As PIL's and torch's antialiased bilinear filter. Equal lengths copy exactly.
class AxisResampler {
 public:
  AxisResampler() = default;
  /// @param from, to lengths, >= 1
  AxisResampler(int32_t from, int32_t to);

  struct Taps {
    int32_t first = 0;  ///< source index of the first weight
    int32_t count = 0;
    const float* weights = nullptr;  ///< sum 1
  };
  /// What output `index` is made of; valid while this object is.
  Taps taps(int32_t index) const {
    const Span& span = spans_[static_cast<size_t>(index)];
    return {span.first, span.count, weights_.data() + span.offset};
  }

 private:
  struct Span {
    int32_t first;
    int32_t count;
    size_t offset;
  };
  std::vector<Span> spans_;
  std::vector<float> weights_;
};

}  // namespace unisim::onnx
