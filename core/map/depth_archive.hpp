// SPDX-License-Identifier: MIT
// Coarse depth of the keyframes that are kept, so that a loop finds its scale at a place left long
// ago.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/span.hpp"
#include "core/map/depth_sampler.hpp"
#include "core/snapshot/archive.hpp"

namespace unisim {

/// A ring by keyframe id. 16x12 depths per keyframe, 384 bytes: log depth in 16 bits, steps of
/// 0.0005, from exp(-16) to exp(16). Fine enough for a median; exact work on young keyframes goes
/// through DepthStore.
class DepthArchive {
 public:
  static constexpr GridSize kGrid = {16, 12};

  DepthArchive() = default;
  DepthArchive(Arena& arena, int32_t keyframes)
      : keyframes_(keyframes), codes_(arena.take<uint16_t>(keyframes * kGrid.cells())) {}

  /// @param depth kGrid.cells() samples, 0 = none
  void put(int32_t keyframe, Span<const float> depth);
  /// Nothing is known of this keyframe: its place may hold another's depth.
  void clear(int32_t keyframe) { place(keyframe).fill(0); }
  /// @param[out] depth kGrid.cells() samples, 0 = none; all 0 when nothing was put
  void get(int32_t keyframe, Span<float> depth) const;

  /// Save or load what is kept of keyframes first .. end - 1.
  void visit(Archive* archive, int32_t first, int32_t end) {
    for (int32_t id = first; archive->ok() && id < end; ++id) {
      for (uint16_t& code : place(id)) archive->value(&code);
    }
  }

 private:
  Span<uint16_t> place(int32_t keyframe) const {
    return codes_.subspan(keyframe % keyframes_ * kGrid.cells(), kGrid.cells());
  }

  int32_t keyframes_ = 1;
  Span<uint16_t> codes_;
};

}  // namespace unisim
