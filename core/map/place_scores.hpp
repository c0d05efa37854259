// SPDX-License-Identifier: MIT
// Dot products of one descriptor with many; vectorised.
#pragma once

#include <cstdint>

#include "core/base/isa.hpp"

namespace unisim {

UNISIM_EACH_ISA(
    /// scores[i] = sum over k of query[k] * rows[i * dimension + k]. A row of 65536 numbers fits.
    void place_scores(const int8_t* query, const int8_t* rows, int32_t count, int32_t dimension,
                      int32_t* scores);)

}  // namespace unisim
