// SPDX-License-Identifier: MIT
// Maps of a predictor in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/predictor.h"
#include "tests/geometric/rendered_room.hpp"

namespace unisim::geometric::test {

using MapBytes = std::vector<uint8_t>;

/// @param room bytes that are taken
int try_save(unisim_predictor* table, MapBytes* out, size_t room = SIZE_MAX);
MapBytes save(unisim_predictor* table);
int try_load(unisim_predictor* table, const MapBytes& map, int32_t* next_keyframe);
/// @return number of the next keyframe
int32_t load(unisim_predictor* table, const MapBytes& map);
int locate(unisim_predictor* table, const GrayImage& image, unisim_location* out);

}  // namespace unisim::geometric::test
