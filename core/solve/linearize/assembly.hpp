// SPDX-License-Identifier: MIT
// Where the blocks of H are put together: in the memory of the factor that overwrites them.
#pragma once

#include <cstdint>
#include <cstring>

#include "core/solve/factor/block.hpp"
#include "core/solve/order/supernodes.hpp"

namespace unisim {

/// How far a supernode is behind its graph.
enum class Staleness : uint8_t {
  kNone,
  kRightSide,  ///< the gradient has changed there or below it in the tree
  kFactor      ///< and so has H
};

/// Whether the numbers of a column are wanted, and whether its blocks are zero for them.
enum class ColumnState : uint8_t { kKept, kWanted, kOpen };

/// Of the diagonal blocks only the lower triangles count. Other columns than the wanted ones hold a
/// part of the factor and are not to be written. Wanted ones do so, too, until open() zeroes them:
/// as late as that they are still in the cache when the first numbers come.
struct Assembly {
  Supernodes S;
  Block* blocks;
  const int32_t* diagonal;      ///< column -> its block
  const int32_t* off_diagonal;  ///< slot of the BlockPattern -> its block
  ColumnState* state;           ///< by column

  bool wants(int32_t column) const { return state[column] != ColumnState::kKept; }
  /// Before the first number is added to a wanted column, or later.
  void open(int32_t column) const {
    if (state[column] == ColumnState::kWanted) open_supernode(S.of_column[column]);
  }
  void open_supernode(int32_t s) const {
    std::memset(static_cast<void*>(blocks + S.block_start[s]), 0,
                static_cast<size_t>(S.block_count(s)) * sizeof(Block));
    for (int32_t j = S.first_column[s]; j < S.first_column[s + 1]; ++j) {
      state[j] = ColumnState::kOpen;
    }
  }
};

}  // namespace unisim
