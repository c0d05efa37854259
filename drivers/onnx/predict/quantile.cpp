// SPDX-License-Identifier: MIT
// Confidence by quantile.
#include "drivers/onnx/predict/quantile.hpp"

#include <algorithm>
#include <cstring>

namespace unisim::onnx {
namespace {

/// Whole numbers in the order of the floats.
uint32_t order_of(float value) {
  uint32_t bits = 0;
  value += 0.0f;  // -0 is 0
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

}  // namespace

void QuantileRanker::rank(float* values, size_t count) {
  if (count < 2) return;
  for (size_t i = 0; i < count; ++i) keys_[i] = uint64_t{order_of(values[i])} << 32 | i;
  std::sort(keys_.begin(), keys_.begin() + static_cast<std::ptrdiff_t>(count));
  for (size_t first = 0, end = 0; first < count; first = end) {
    while (end < count && keys_[end] >> 32 == keys_[first] >> 32) ++end;
    const double mean = 0.5 * static_cast<double>(first + end - 1);
    const auto share = static_cast<float>(mean / static_cast<double>(count - 1));
    for (size_t k = first; k < end; ++k) values[keys_[k] & 0xffffffffu] = share;
  }
}

}  // namespace unisim::onnx
