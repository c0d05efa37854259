// SPDX-License-Identifier: MIT
// Which predictors have places; tables of older programs end before them.
#pragma once

#include <cstddef>

#include "drivers/predictor.h"

namespace unisim::drivers {

/// place_descriptor() and release_place() can be called.
inline bool has_places(const unisim_predictor& predictor) {
  constexpr size_t kNeeded =
      offsetof(unisim_predictor, release_place) + sizeof(unisim_predictor::release_place);
  return predictor.struct_size >= kNeeded && predictor.place_descriptor != nullptr &&
         predictor.release_place != nullptr;
}

}  // namespace unisim::drivers
