// SPDX-License-Identifier: MIT
// Coarse depth of the keyframes that are kept, so that a loop finds its scale at a place left long
// ago.
#include "core/map/depth_archive.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"

namespace unisim {
namespace {

constexpr double kLogRange = 16.0;  // codes 1..65535 span log depths -16..16; 0 is "none"
constexpr double kLastCode = 65535.0;
constexpr double kStep = 2.0 * kLogRange / (kLastCode - 1.0);

}  // namespace

void DepthArchive::put(int32_t keyframe, Span<const float> depth) {
  const Span<uint16_t> codes = place(keyframe);
  for (int32_t cell = 0; cell < codes.size(); ++cell) {
    if (depth[cell] <= 0.0F) {
      codes[cell] = 0;
      continue;
    }
    const double code = 1.0 + std::floor((math::log(depth[cell]) + kLogRange) / kStep + 0.5);
    codes[cell] = static_cast<uint16_t>(std::min(std::max(code, 1.0), kLastCode));
  }
}

void DepthArchive::get(int32_t keyframe, Span<float> depth) const {
  const Span<const uint16_t> codes = place(keyframe);
  for (int32_t cell = 0; cell < codes.size(); ++cell) {
    const double log_depth = (codes[cell] - 1) * kStep - kLogRange;
    depth[cell] = codes[cell] == 0 ? 0.0F : static_cast<float>(math::exp(log_depth));
  }
}

}  // namespace unisim
