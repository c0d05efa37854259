// SPDX-License-Identifier: MIT
// Turns on the spot, after which the size of all that is seen is a guess.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

/// A camera that turns on the spot sweeps everything it has measured out of view, and parallax to
/// measure the new is missing. Depths are then guessed from neighbours, and the map goes on in a
/// size that nothing measured says. Each such keyframe is kept here until landmarks from before the
/// turn are seen again, which sets the size right.
class SpotTurns {
 public:
  void reserve(size_t keyframes) { open_.reserve(keyframes); }

  /// Looks at the newest keyframe, which has a pose and its observations.
  void see_keyframe(const State& state, int32_t id);
  /// Forgets turns since which landmarks from before are seen again.
  void settle(const State& state);

  /// Is the size of what one of these keyframes sees a guess, as far as is known now?
  bool guessed(int32_t first, int32_t last) const;
  /// Keyframes from this one on are of one size; 0: all are.
  int32_t firm_from() const { return open_.empty() ? 0 : open_.back().after; }

 private:
  struct Turn {
    int32_t before;  ///< last keyframe that looked elsewhere
    int32_t after;
    int32_t carriers;  ///< landmarks from before that are seen since; of the last settle()
  };

  std::vector<Turn> open_;  // ascending
};

}  // namespace unisim::geometric
