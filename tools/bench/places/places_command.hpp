// SPDX-License-Identifier: MIT
// unisim-bench places: time of a search among many keyframes, and of adding one.
#pragma once

#include <cstdint>

namespace unisim::bench {

struct PlacesSettings {
  int32_t keyframes = 10000;
  int32_t repeat = 101;  ///< searches
  bool json = false;
};

/// @return exit code
int places_command(const PlacesSettings& settings);

}  // namespace unisim::bench
