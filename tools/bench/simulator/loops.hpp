// SPDX-License-Identifier: MIT
// Where a walk comes back to a place it has seen.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/bench/simulator/world.hpp"

namespace unisim::simulator {

inline constexpr int32_t kLoopHalf = 8;  ///< keyframes around each of the two places

struct Loop {
  int32_t query = 0;  ///< the later keyframe
  int32_t match = 0;
  bool is_false = false;  ///< two places that look alike: the prediction puts them together

  /// First keyframe of the eight around a place.
  static int32_t first_around(int32_t keyframe, int32_t keyframes);
};

/// Loops of a world in order of their query, at most one for every 14 keyframes: the earlier view,
/// 60 keyframes away or more, that sees most nearly the same.
std::vector<Loop> find_loops(const World& world);

/// Loops that are none, so many that they are `share` of all together with the given ones; same
/// result for same arguments. The sum is ordered by query.
std::vector<Loop> with_false_loops(const World& world, std::vector<Loop> loops, double share,
                                   uint64_t seed);

}  // namespace unisim::simulator
