// SPDX-License-Identifier: MIT
// The image of --mask: what is never looked at.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/image.h"
#include "tools/replay/options.hpp"

namespace unisim::replay {

struct Mask {
  unisim_image view{};          ///< GRAY8, 0 where nothing is to be looked at; data NULL: no mask
  std::vector<uint8_t> pixels;  ///< of the view
};

/// Reads options.mask: darker than half of its brightest pixel hides, so that 0/255, 0/1 and JPEG
/// images all serve. Throws Failure (3): unreadable, hides everything, or not of the frames' size.
Mask load_mask(const Options& options);

}  // namespace unisim::replay
