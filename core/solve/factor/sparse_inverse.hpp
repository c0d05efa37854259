// SPDX-License-Identifier: MIT
// Blocks of (L L')^-1 on the pattern of L, by recursion from the root of the elimination tree.
#pragma once

#include "core/solve/order/supernodes.hpp"

namespace unisim {

/// The recursion of Takahashi, Fagan and Chin, in place. With R the rows of L below column j, the
/// blocks of S = (L L')^-1 are
///
///     S_Rj = -S_RR Y    S_jj = L_jj^-T L_jj^-1 - Y' S_Rj    with Y = L_Rj L_jj^-1 .
///
/// What S_RR holds lies on the pattern of L, in columns above j in the tree: one column needs the
/// way to the root, all of them cost about three times the factorisation.
struct InverseTask {
  Supernodes S;
  Block* blocks;      ///< L; of inverted supernodes S, the diagonal blocks whole
  BlockVector* work;  ///< columns, overwritten
  int32_t* place;     ///< columns, overwritten
};

// invert_supernode(): turns the blocks of supernode s into those of S. All above it have been
// turned.
UNISIM_EACH_WIDE_ISA(void invert_supernode(const InverseTask& task, int32_t s);)

}  // namespace unisim
