// SPDX-License-Identifier: MIT
// The two places that a loop joins.
#pragma once

#include <cstdint>

#include "core/map/map.hpp"

namespace unisim {

/// First view of the second place: behind the widest gap between keyframes that take part.
/// submap.count when there is no gap.
inline int32_t second_place(const Map& map, const Submap& loop) {
  int32_t before = -1;
  int32_t widest = 0;
  int32_t split = loop.count;
  for (int32_t k = 0; k < loop.count; ++k) {
    const SubmapView& view = map.submaps.view(loop, k);
    if (!view.used || !map.keyframes.has(view.keyframe)) continue;
    if (before >= 0 && view.keyframe - before > widest) {
      widest = view.keyframe - before;
      split = k;
    }
    before = view.keyframe;
  }
  return split;
}

}  // namespace unisim
