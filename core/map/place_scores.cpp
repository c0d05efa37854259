// SPDX-License-Identifier: MIT
// Dot products of one descriptor with many; vectorised.
#include "core/map/place_scores.hpp"

#include <cstddef>

namespace unisim {
namespace UNISIM_ISA {

void place_scores(const int8_t* query, const int8_t* rows, int32_t count, int32_t dimension,
                  int32_t* scores) {
  for (int32_t i = 0; i < count; ++i) {
    const int8_t* row = rows + static_cast<size_t>(i) * static_cast<size_t>(dimension);
    int32_t sum = 0;
    for (int32_t k = 0; k < dimension; ++k) {
      // In 16 bits first: compilers then add products in pairs, without widening each.
      const auto a = static_cast<int16_t>(query[k]);
      const auto b = static_cast<int16_t>(row[k]);
      sum += static_cast<int32_t>(a) * static_cast<int32_t>(b);
    }
    scores[i] = sum;
  }
}

}  // namespace UNISIM_ISA
}  // namespace unisim
