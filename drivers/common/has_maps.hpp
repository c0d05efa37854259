// SPDX-License-Identifier: MIT
// Which predictors keep maps; tables of older programs end before them.
#pragma once

#include <cstddef>

#include "drivers/predictor.h"

namespace unisim::drivers {

/// save_map(), load_map(), locate() and map_pose() can be called.
inline bool has_maps(const unisim_predictor& predictor) {
  constexpr size_t kNeeded =
      offsetof(unisim_predictor, map_pose) + sizeof(unisim_predictor::map_pose);
  return predictor.struct_size >= kNeeded && predictor.save_map != nullptr &&
         predictor.load_map != nullptr && predictor.locate != nullptr &&
         predictor.map_pose != nullptr;
}

}  // namespace unisim::drivers
