// SPDX-License-Identifier: MIT
// Dense kernels on padded 7x7 blocks. No heap, no branches on data but the pivot test.
#pragma once

#include "core/solve/block.hpp"

namespace unisim {

// Doubles the vector unit of this build handles at once. Each element is computed by the same
// operations in the same order whatever the width; only builds that fuse multiply and add round
// differently.
#if defined(__AVX512F__)
inline constexpr int kLane = 8;
#elif defined(__AVX__)
inline constexpr int kLane = 4;
#else
inline constexpr int kLane = 2;
#endif
inline constexpr int kLanes = kBlockRows / kLane;

using Lane = double __attribute__((vector_size(kLane * sizeof(double))));

inline Lane* lanes(double* column) { return reinterpret_cast<Lane*>(column); }
inline const Lane* lanes(const double* column) { return reinterpret_cast<const Lane*>(column); }

/// kColumns columns of C -= A B' from column kFirst on; kLower leaves out lanes above the diagonal.
template <int kFirst, int kColumns, bool kLower>
inline void subtract_product_columns(Block& C, const Block& A, const Block& B) {
  constexpr int kSkip = kLower ? kFirst / kLane : 0;
  Lane c[kColumns][kLanes];
  for (int j = 0; j < kColumns; ++j) {
    for (int l = kSkip; l < kLanes; ++l) c[j][l] = lanes(C.v + kBlockRows * (kFirst + j))[l];
  }
  for (int k = 0; k < kTangentDim; ++k) {
    const Lane* a = lanes(A.v + kBlockRows * k);
    const double* b = B.v + kBlockRows * k + kFirst;
    for (int l = kSkip; l < kLanes; ++l) {
      for (int j = 0; j < kColumns; ++j) c[j][l] -= a[l] * b[j];
    }
  }
  for (int j = 0; j < kColumns; ++j) {
    for (int l = kSkip; l < kLanes; ++l) lanes(C.v + kBlockRows * (kFirst + j))[l] = c[j][l];
  }
}

/// C -= A B'.
inline void subtract_product(Block& C, const Block& A, const Block& B) {
  if constexpr (kLane >= 4) {
    subtract_product_columns<0, 4, false>(C, A, B);
    subtract_product_columns<4, 3, false>(C, A, B);
  } else {
    subtract_product_columns<0, 2, false>(C, A, B);
    subtract_product_columns<2, 2, false>(C, A, B);
    subtract_product_columns<4, 3, false>(C, A, B);
  }
}

/// Lower triangle of C -= A A'; above the diagonal C is left with numbers of no meaning.
inline void subtract_gram(Block& C, const Block& A) {
  subtract_product_columns<0, 2, true>(C, A, A);
  subtract_product_columns<2, 2, true>(C, A, A);
  subtract_product_columns<4, 3, true>(C, A, A);
}

/// C := C L'^-1 for the factor L of a diagonal block as factorize_diagonal() leaves it.
inline void solve_right(Block& C, const Block& L) {
  for (int j = 0; j < kTangentDim; ++j) {
    Lane c[kLanes];
    for (int l = 0; l < kLanes; ++l) c[l] = lanes(C.v + kBlockRows * j)[l];
    for (int k = 0; k < j; ++k) {
      const double factor = L.at(j, k);
      for (int l = 0; l < kLanes; ++l) c[l] -= lanes(C.v + kBlockRows * k)[l] * factor;
    }
    const double inverse = L.at(j, j);
    for (int l = 0; l < kLanes; ++l) lanes(C.v + kBlockRows * j)[l] = c[l] * inverse;
  }
}

/// Cholesky factor of the lower triangle of D in place; the diagonal holds the inverses of that of
/// L.
/// @param floor pivots at or below their floor count as not positive
/// @return false when a pivot is not positive or not finite
bool factorize_diagonal(Block& D, const double floor[kTangentDim]);

/// x := L^-1 x, x := L'^-1 x for a factor of factorize_diagonal().
void solve_lower(const Block& L, BlockVector& x);
void solve_lower_transposed(const Block& L, BlockVector& x);

/// y -= A x.
inline void subtract_times(BlockVector& y, const Block& A, const BlockVector& x) {
  Lane sum[kLanes];
  for (int l = 0; l < kLanes; ++l) sum[l] = lanes(y.v)[l];
  for (int k = 0; k < kTangentDim; ++k) {
    for (int l = 0; l < kLanes; ++l) sum[l] -= lanes(A.v + kBlockRows * k)[l] * x.v[k];
  }
  for (int l = 0; l < kLanes; ++l) lanes(y.v)[l] = sum[l];
}

/// y -= A' x.
inline void subtract_transposed_times(BlockVector& y, const Block& A, const BlockVector& x) {
  for (int k = 0; k < kTangentDim; ++k) {
    double sum = 0.0;
    for (int r = 0; r < kTangentDim; ++r) sum += A.at(r, k) * x.v[r];
    y.v[k] -= sum;
  }
}

}  // namespace unisim
