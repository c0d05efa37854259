// SPDX-License-Identifier: MIT
// One supernode of a block factor, for vectorised sources.
#pragma once

#include "core/solve/order/supernodes.hpp"

namespace unisim {
namespace UNISIM_ISA {

/// A run of columns and its part of L.
struct Run {
  UNISIM_ALWAYS_INLINE Run(const Supernodes& S, int32_t s)
      : first(S.first_column[s]),
        width(S.first_column[s + 1] - first),
        row_count(S.row_start[s + 1] - S.row_start[s]),
        rows(S.rows + S.row_start[s]),
        offset(S.block_start[s]) {}

  int32_t first;      ///< column
  int32_t width;      ///< columns
  int32_t row_count;  ///< below the run
  const int32_t* rows;
  int32_t offset;  ///< of its blocks

  /// Rows of the run: 0 .. width - 1 are those of the triangle, then those below.
  UNISIM_ALWAYS_INLINE int32_t row_end() const { return width + row_count; }
  /// Block row of L.
  UNISIM_ALWAYS_INLINE int32_t block_row(int32_t row) const {
    return row < width ? first + row : rows[row - width];
  }
  /// Where the blocks of a row begin.
  UNISIM_ALWAYS_INLINE int32_t row_offset(int32_t row) const {
    return offset + (row < width ? triangle(row) : triangle(width) + (row - width) * width);
  }
};

}  // namespace UNISIM_ISA
}  // namespace unisim
