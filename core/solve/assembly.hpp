// SPDX-License-Identifier: MIT
// Where the blocks of H are put together: in the memory of the factor that overwrites them.
#pragma once

#include <cstdint>

#include "core/solve/block.hpp"

namespace unisim {

/// Of the diagonal blocks only the lower triangles count. Columns that are not stale hold a part of
/// the factor and are not to be written.
struct Assembly {
  Block* blocks;
  const int32_t* diagonal;      ///< column -> its block
  const int32_t* off_diagonal;  ///< slot of the BlockPattern -> its block
  const int32_t* of_column;     ///< column -> supernode
  const uint8_t* stale;         ///< supernode -> 1: H is wanted there

  bool wants(int32_t column) const { return stale[of_column[column]] != 0; }
};

}  // namespace unisim
