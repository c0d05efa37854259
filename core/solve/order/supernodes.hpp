// SPDX-License-Identifier: MIT
// Layout of a supernodal block factor, as plain arrays for the vectorised kernels.
#pragma once

#include <cstdint>

#include "core/solve/factor/block.hpp"

namespace unisim {

/// A Cholesky factor L in supernodes: runs of columns that share their rows below the run.
///
///     columns 3..5 with rows 7, 9 below, w = 3:      stored by block rows, each as long as it is
///     row 3   [ b0          ]                        non-zero; the triangle first, then the rows
///     row 4   [ b1  b2      ]                        below, w blocks each: a product with all
///     row 5   [ b3  b4  b5  ]                        columns of the run is one sweep over memory
///     row 7   [ b6  b7  b8  ]
///     row 9   [ b9  b10 b11 ]
///
/// Once factorised, the diagonal blocks hold L_jj^-1 by rows (block_kernels.hpp).
struct Supernodes {
  int32_t block_count(int32_t s) const;

  int32_t count = 0;
  const int32_t* first_column = nullptr;  ///< count + 1
  const int32_t* of_column = nullptr;     ///< columns
  const int32_t* row_start = nullptr;     ///< count + 1 offsets into rows
  const int32_t* rows = nullptr;          ///< block rows below each run, ascending
  const int32_t* block_start = nullptr;   ///< where the blocks of each run begin
};

/// Blocks of a triangle of w block rows: where the rows below it begin.
UNISIM_ALWAYS_INLINE int32_t triangle(int32_t w) { return w * (w + 1) / 2; }

inline int32_t Supernodes::block_count(int32_t s) const {
  const int32_t width = first_column[s + 1] - first_column[s];
  return triangle(width) + width * (row_start[s + 1] - row_start[s]);
}

/// Lists that a left-looking factorisation threads through the supernodes.
struct SupernodeLists {
  int32_t* first;     ///< supernode -> first one that waits to update it, -1: none
  int32_t* next;      ///< the next one
  int32_t* position;  ///< which of its rows is the first in the supernode it waits for
  int32_t* place;     ///< block row -> place in the present supernode
};

}  // namespace unisim
