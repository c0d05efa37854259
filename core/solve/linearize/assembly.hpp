// SPDX-License-Identifier: MIT
// Where the blocks of H are put together: in the memory of the factor that overwrites them.
#pragma once

#include <cstdint>

#include "core/solve/factor/block.hpp"

namespace unisim {

/// How far a supernode is behind its graph.
enum class Staleness : uint8_t {
  kNone,
  kRightSide,  ///< the gradient has changed there or below it in the tree
  kFactor      ///< and so has H
};

/// Of the diagonal blocks only the lower triangles count. Other columns than the wanted ones hold a
/// part of the factor and are not to be written.
struct Assembly {
  Block* blocks;
  const int32_t* diagonal;      ///< column -> its block
  const int32_t* off_diagonal;  ///< slot of the BlockPattern -> its block
  const int32_t* of_column;     ///< column -> supernode
  const Staleness* stale;       ///< by supernode; kFactor: H is wanted there

  bool wants(int32_t column) const { return stale[of_column[column]] == Staleness::kFactor; }
};

}  // namespace unisim
