// SPDX-License-Identifier: MIT
// unisim-bench lanes: what a predictor that takes long for its windows costs the live pose.
#pragma once

#include <cstdint>

namespace unisim::bench {

struct LanesSettings {
  int32_t keyframes = 90;  ///< of one run, 6 a second
  int32_t repeat = 3;      ///< pairs of runs
  double window_s = 2.0;   ///< for a window
  double pair_ms = 10.0;   ///< for a pair, computing
  bool busy = false;       ///< windows are computed on this processor, not elsewhere
  bool json = false;
};

/// @return exit code
int lanes_command(const LanesSettings& settings);

}  // namespace unisim::bench
