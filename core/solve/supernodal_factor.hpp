// SPDX-License-Identifier: MIT
// Numeric phase of the supernodal block Cholesky factorisation; vectorised.
#pragma once

#include "core/solve/supernodes.hpp"

namespace unisim {

/// The numeric phase, one set of functions per instruction set.
struct SupernodalKernels {
  /// L L' = H + lambda diag(H), left-looking over the supernodes.
  /// @return -1; else the column whose pivot is not finite or not above 1e-13 of its diagonal
  int32_t (*factorize)(const Supernodes& S, const PlainBlockMatrix& H, double lambda,
                       const SupernodeLists& lists, Block* L);
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
