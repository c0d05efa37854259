// SPDX-License-Identifier: MIT
// Coarse depth of every keyframe, so that a loop finds its scale at a place left long ago.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/span.hpp"
#include "core/map/depth_sampler.hpp"

namespace unisim {

/// 16x12 depths per keyframe, 384 bytes: log depth in 16 bits, steps of 0.0005, from exp(-16) to
/// exp(16). Fine enough for a median; exact work on young keyframes goes through DepthStore.
class DepthArchive {
 public:
  static constexpr GridSize kGrid = {16, 12};

  DepthArchive() = default;
  DepthArchive(Arena& arena, int32_t keyframes)
      : codes_(arena.take<uint16_t>(keyframes * kGrid.cells())) {}

  /// @param depth kGrid.cells() samples, 0 = none
  void put(int32_t keyframe, Span<const float> depth);
  /// @param[out] depth kGrid.cells() samples, 0 = none; all 0 when nothing was put
  void get(int32_t keyframe, Span<float> depth) const;

 private:
  Span<uint16_t> codes_;
};

}  // namespace unisim
