// SPDX-License-Identifier: MIT
// Numeric phase of the supernodal block Cholesky factorisation; vectorised.
#pragma once

#include "core/solve/assembly.hpp"
#include "core/solve/supernodes.hpp"

namespace unisim {

/// What a factorisation works on. The blocks hold H where they are stale, L elsewhere.
struct FactorTask {
  Supernodes S;
  SupernodeLists lists;
  const Staleness* stale;  ///< by supernode; an ancestor is at least as stale
  double lambda;           ///< damping
  Block* blocks;           ///< H, overwritten by L
  BlockVector*
      H_diagonal;  ///< columns; [out] the diagonal of H before damping, where that is stale
  /// Columns, or nullptr: x := L^-1 x on the way, while L is at hand. Where nothing is stale x is
  /// the result of the last time already.
  BlockVector* x;
};

/// The numeric phase, one set of functions per instruction set.
struct SupernodalKernels {
  /// L L' = H + lambda diag(H), left-looking over the supernodes.
  /// @return -1; else the column whose pivot is not finite or not above 1e-13 of its diagonal
  int32_t (*factorize)(const FactorTask& task);
  /// x := L^-1 x for the supernodes begin .. end - 1.
  void (*forward)(const Supernodes& S, const Block* L, int32_t begin, int32_t end, BlockVector* x);
  /// x := L'^-1 x for the supernodes begin .. end - 1.
  void (*backward)(const Supernodes& S, const Block* L, int32_t begin, int32_t end, BlockVector* x);
};

namespace baseline {
extern const SupernodalKernels kSupernodal;
}
#ifdef UNISIM_HAS_AVX2
namespace avx2 {
extern const SupernodalKernels kSupernodal;
}
#endif

}  // namespace unisim
