// SPDX-License-Identifier: MIT
// One descriptor of a whole image from its binary features: VLAD (vectors of locally aggregated
// descriptors) on ORB.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace unisim::geometric {

inline constexpr int kOrbBytes = 32;
inline constexpr int kOrbBits = 8 * kOrbBytes;
inline constexpr int kVladWordCount = 64;
inline constexpr int kVladAxisCount = 16;
inline constexpr int kVladSize = kVladWordCount * kVladAxisCount;

// Trained by tools/train_places.py: binary words, directions in the space of the 256 bits as +-1,
// and the words' means along these.
extern const uint8_t kVladWords[kVladWordCount * kOrbBytes];
extern const float kVladAxisUnit;  // of the numbers in kVladAxes
extern const int8_t kVladAxes[kOrbBits * kVladAxisCount];
extern const int16_t kVladOffsets[kVladWordCount * kVladAxisCount];  // in 1/1000

/// Sums, by nearest word, of the features' distances to the word's mean along the axes; each word's
/// sum and then the whole brought to one length.
/// @param features rows of kOrbBytes  @param[out] out kVladSize numbers in -127..127
/// @return false, all zero: there is not one feature
bool describe_image(const cv::Mat& features, int8_t* out);

}  // namespace unisim::geometric
