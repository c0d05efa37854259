// SPDX-License-Identifier: MIT
// Numeric phase of the supernodal block Cholesky factorisation; vectorised.
#pragma once

#include "core/solve/linearize/assembly.hpp"
#include "core/solve/order/supernodes.hpp"

namespace unisim {

/// What a factorisation works on. The blocks hold H where they are stale, L elsewhere.
struct FactorTask {
  Supernodes S;
  SupernodeLists lists;
  const Staleness* stale;   ///< by supernode; an ancestor is at least as stale
  double lambda;            ///< damping
  Block* blocks;            ///< H, overwritten by L
  BlockVector* H_diagonal;  ///< columns; [out] where H is stale its diagonal before damping
  /// Columns, or nullptr: x := L^-1 x on the way, while L is at hand. Where nothing is stale x is
  /// the result of the last time already.
  BlockVector* x;
};

// factorize_supernodes(): L L' = H + lambda diag(H), left-looking over the supernodes.
// @return -1; else the column whose pivot is not finite or not above 1e-13 of its diagonal
// forward_supernodes(): x := L^-1 x for the supernodes begin .. end - 1.
// backward_supernodes(): x := L'^-1 x for them.
UNISIM_EACH_WIDE_ISA(int32_t factorize_supernodes(const FactorTask& task);
                     void forward_supernodes(const Supernodes& S, const Block* L, int32_t begin,
                                             int32_t end, BlockVector* x);
                     void backward_supernodes(const Supernodes& S, const Block* L, int32_t begin,
                                              int32_t end, BlockVector* x);)

}  // namespace unisim
