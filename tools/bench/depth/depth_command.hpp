// SPDX-License-Identifier: MIT
// unisim-bench depth: the ratio of two depth maps, by size.
#pragma once

#include <cstdint>

namespace unisim::bench {

struct DepthSettings {
  int32_t repeat = 11;  ///< measurements per size, the median is shown
  bool json = false;
};

/// Print the time of one ratio per size. @return exit code
int depth_command(const DepthSettings& settings);

}  // namespace unisim::bench
