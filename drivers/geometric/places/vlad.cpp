// SPDX-License-Identifier: MIT
// One descriptor of a whole image from its binary features.
#include "drivers/geometric/places/vlad.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace unisim::geometric {

namespace {

// Numbers of the result have a standard deviation of 1/32 of the whole's length; four of them
// reach the limit of int8.
constexpr double kUnit = 127.0 / 4.0;

using Sums = std::array<float, kVladAxisCount>;

/// The nearest word of each feature.
cv::Mat nearest_words(const cv::Mat& features) {
  // cv::Mat has no read-only view; the words are only read.
  const cv::Mat words(kVladWordCount, kOrbBytes, CV_8UC1, const_cast<uint8_t*>(kVladWords));
  cv::Mat distance;
  cv::Mat nearest;
  cv::batchDistance(features, words, distance, CV_32S, nearest, cv::NORM_HAMMING, 1);
  return nearest;
}

/// The sum of the residuals of `count` features whose bits, as +-1, add up to `bits`.
Sums residual_of(int word, int count, const int32_t* bits) {
  Sums out{};
  for (int b = 0; b < kOrbBits; ++b) {
    const int8_t* axis = kVladAxes + static_cast<ptrdiff_t>(b) * kVladAxisCount;
    for (size_t a = 0; a < kVladAxisCount; ++a) out[a] += static_cast<float>(bits[b] * axis[a]);
  }
  for (size_t a = 0; a < kVladAxisCount; ++a) {
    const int16_t offset = kVladOffsets[static_cast<size_t>(word) * kVladAxisCount + a];
    out[a] = out[a] * kVladAxisUnit - static_cast<float>(count) * static_cast<float>(offset) / 1000;
  }
  return out;
}

}  // namespace

bool describe_image(const cv::Mat& features, int8_t* out) {
  std::fill(out, out + kVladSize, int8_t{0});
  if (features.empty()) return false;
  std::array<int32_t, kVladWordCount> counts{};
  std::array<int32_t, static_cast<size_t>(kVladWordCount) * kOrbBits> bits{};
  const cv::Mat nearest = nearest_words(features);
  for (int row = 0; row < features.rows; ++row) {
    const auto* feature = features.ptr<uint8_t>(row);
    const int word = nearest.at<int>(row);
    ++counts[static_cast<size_t>(word)];
    int32_t* sums = bits.data() + static_cast<ptrdiff_t>(word) * kOrbBits;
    for (int b = 0; b < kOrbBits; ++b) sums[b] += (feature[b / 8] >> (b % 8)) & 1 ? 1 : -1;
  }
  std::array<Sums, kVladWordCount> words{};
  int used = 0;
  for (int word = 0; word < kVladWordCount; ++word) {
    const int count = counts[static_cast<size_t>(word)];
    if (count == 0) continue;
    Sums& sums = words[static_cast<size_t>(word)];
    sums = residual_of(word, count, bits.data() + static_cast<ptrdiff_t>(word) * kOrbBits);
    float square = 0;
    for (const float value : sums) square += value * value;
    const float scale = square > 0 ? 1 / std::sqrt(square) : 0;
    for (float& value : sums) value *= scale;
    ++used;
  }
  const double scale = kUnit * std::sqrt(static_cast<double>(kVladSize) / used);
  for (int i = 0; i < kVladSize; ++i) {
    const Sums& sums = words[static_cast<size_t>(i / kVladAxisCount)];
    const double value = scale * static_cast<double>(sums[static_cast<size_t>(i % kVladAxisCount)]);
    out[i] = static_cast<int8_t>(std::clamp(std::round(value), -127.0, 127.0));
  }
  return true;
}

}  // namespace unisim::geometric
