// SPDX-License-Identifier: MIT
// Storage of one 7x7 block for the vector unit.
#pragma once

#include "core/base/isa.hpp"
#include "core/base/tangent_dim.hpp"

namespace unisim {

/// Rows of a stored column: 7 and one of padding, always zero, so that a column is a cache line.
inline constexpr int kBlockRows = 8;

/// 7x7 matrix, column-major, 8 rows each.
struct alignas(64) Block {
  double v[kBlockRows * kTangentDim];

  UNISIM_ALWAYS_INLINE double& at(int row, int column) { return v[column * kBlockRows + row]; }
  UNISIM_ALWAYS_INLINE double at(int row, int column) const { return v[column * kBlockRows + row]; }
};
static_assert(sizeof(Block) == 448, "seven cache lines");

/// Seven numbers and one of padding.
struct alignas(64) BlockVector {
  double v[kBlockRows];
};

}  // namespace unisim
