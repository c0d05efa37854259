// SPDX-License-Identifier: MIT
// Dense kernels on padded 7x7 blocks. No heap, no branches on data but the pivot test.
#pragma once

#include "core/base/pack.hpp"
#include "core/solve/factor/block.hpp"

namespace unisim {
namespace UNISIM_ISA {

// Rows of a column go into lanes: with AVX-512 all of them into one.
#if defined(__AVX512F__)
inline constexpr int kLane = 8;  // doubles in a lane
#else
inline constexpr int kLane = kPackLanes;
#endif
inline constexpr int kLanes = kBlockRows / kLane;

// Keeps what the loops index in registers.
#define UNISIM_UNROLL _Pragma("GCC unroll 8")

using Lane = double __attribute__((vector_size(kLane * sizeof(double))));

UNISIM_ALWAYS_INLINE Lane* lanes(double* column) { return reinterpret_cast<Lane*>(column); }
UNISIM_ALWAYS_INLINE const Lane* lanes(const double* column) {
  return reinterpret_cast<const Lane*>(column);
}

UNISIM_ALWAYS_INLINE const Pack* packs(const double* column) {
  return reinterpret_cast<const Pack*>(column);
}

/// kColumns columns of C -= sum_k A[k] B[k]' from column kFirst on, over `count` blocks; kLower
/// leaves out lanes above the diagonal.
template <int kFirst, int kColumns, bool kLower>
UNISIM_ALWAYS_INLINE void subtract_products_columns(Block& C, const Block* A, const Block* B,
                                                    int count) {
  constexpr int kSkip = kLower ? kFirst / kLane : 0;
  Lane c[kColumns][kLanes];
  for (int j = 0; j < kColumns; ++j) {
    for (int l = kSkip; l < kLanes; ++l) c[j][l] = lanes(C.v + kBlockRows * (kFirst + j))[l];
  }
  // The columns of neighbouring blocks follow each other in memory.
  const double* a = A->v;
  const double* b = B->v + kFirst;
  for (int k = 0; k < kTangentDim * count; ++k, a += kBlockRows, b += kBlockRows) {
    for (int j = 0; j < kColumns; ++j) {
      for (int l = kSkip; l < kLanes; ++l) c[j][l] -= lanes(a)[l] * b[j];
    }
  }
  for (int j = 0; j < kColumns; ++j) {
    for (int l = kSkip; l < kLanes; ++l) lanes(C.v + kBlockRows * (kFirst + j))[l] = c[j][l];
  }
}

/// C -= sum_k A[k] B[k]' over `count` blocks each.
UNISIM_ALWAYS_INLINE void subtract_products(Block& C, const Block* A, const Block* B, int count) {
  if constexpr (kLane == 8) {
    subtract_products_columns<0, kTangentDim, false>(C, A, B, count);
  } else if constexpr (kLane == 4) {
    subtract_products_columns<0, 4, false>(C, A, B, count);
    subtract_products_columns<4, 3, false>(C, A, B, count);
  } else {
    subtract_products_columns<0, 2, false>(C, A, B, count);
    subtract_products_columns<2, 2, false>(C, A, B, count);
    subtract_products_columns<4, 3, false>(C, A, B, count);
  }
}

/// Lower triangle of C -= sum_k A[k] A[k]'; above the diagonal C is left with numbers of no
/// meaning.
UNISIM_ALWAYS_INLINE void subtract_grams(Block& C, const Block* A, int count) {
  if constexpr (kLane == 8) {
    subtract_products_columns<0, kTangentDim, true>(C, A, A, count);
  } else {
    subtract_products_columns<0, 4, true>(C, A, A, count);
    subtract_products_columns<4, 3, true>(C, A, A, count);
  }
}

alignas(64) inline constexpr double kUnitRows[kTangentDim][kBlockRows] = {
    {1, 0, 0, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0, 0, 0},
    {0, 0, 0, 1, 0, 0, 0, 0}, {0, 0, 0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 1, 0, 0},
    {0, 0, 0, 0, 0, 0, 1, 0}};

/// D := L^-1 for the Cholesky factor L of D, of which the lower triangle is read. The inverse is
/// stored by rows, the only block that is: a solve with it is a product, whose elements do not
/// wait for each other.
/// @param floor pivots at or below their floor count as not positive
/// @return false when a pivot is not positive or not finite
UNISIM_ALWAYS_INLINE bool invert_factor(Block& D, const double* floor) {
  // D = M diag(d) M' with unit M: the square roots come last and all at once.
  Lane c[kTangentDim][kLanes];
  alignas(64) double M[kTangentDim][kBlockRows];
  double d[kTangentDim];
  UNISIM_UNROLL
  for (int j = 0; j < kTangentDim; ++j) {
    for (int l = 0; l < kLanes; ++l) c[j][l] = lanes(D.v + kBlockRows * j)[l];
  }
  UNISIM_UNROLL
  for (int j = 0; j < kTangentDim; ++j) {
    const double pivot = c[j][j / kLane][j % kLane];
    if (!(pivot > floor[j]) || !__builtin_isfinite(pivot)) return false;
    d[j] = pivot;
    const double inverse = 1.0 / pivot;
    for (int l = 0; l < kLanes; ++l) lanes(M[j])[l] = c[j][l] * inverse;
    UNISIM_UNROLL
    for (int k = j + 1; k < kTangentDim; ++k) {
      for (int l = k / kLane; l < kLanes; ++l) c[k][l] -= c[j][l] * M[j][k];
    }
  }
  UNISIM_UNROLL
  for (int i = 0; i < kTangentDim; ++i) {
    Lane row[kLanes];
    for (int l = 0; l < kLanes; ++l) row[l] = lanes(kUnitRows[i])[l];
    UNISIM_UNROLL
    for (int k = 0; k < i; ++k) {
      for (int l = 0; l <= k / kLane; ++l) row[l] -= lanes(D.v + kBlockRows * k)[l] * M[k][i];
    }
    for (int l = 0; l < kLanes; ++l) lanes(D.v + kBlockRows * i)[l] = row[l];
  }
  UNISIM_UNROLL
  for (int i = 0; i < kTangentDim; ++i) {
    const double scale = 1.0 / __builtin_sqrt(d[i]);
    for (int l = 0; l < kLanes; ++l) lanes(D.v + kBlockRows * i)[l] *= scale;
  }
  return true;
}

/// C := C L'^-1 for an inverse of invert_factor().
UNISIM_ALWAYS_INLINE void solve_right(Block& C, const Block& L_inverse) {
  UNISIM_UNROLL
  for (int j = kTangentDim - 1; j >= 0; --j) {
    const double* row = L_inverse.v + kBlockRows * j;
    Lane c[kLanes];
    for (int l = 0; l < kLanes; ++l) c[l] = lanes(C.v)[l] * row[0];
    UNISIM_UNROLL
    for (int k = 1; k <= j; ++k) {
      for (int l = 0; l < kLanes; ++l) c[l] += lanes(C.v + kBlockRows * k)[l] * row[k];
    }
    for (int l = 0; l < kLanes; ++l) lanes(C.v + kBlockRows * j)[l] = c[l];
  }
}

/// y -= sum_k A[k] x[k] over `count` blocks.
UNISIM_ALWAYS_INLINE void subtract_times(BlockVector& y, const Block* A, const BlockVector* x,
                                         int count) {
  Lane sum[kLanes];
  for (int l = 0; l < kLanes; ++l) sum[l] = lanes(y.v)[l];
  for (int block = 0; block < count; ++block) {
    for (int k = 0; k < kTangentDim; ++k) {
      for (int l = 0; l < kLanes; ++l) {
        sum[l] -= lanes(A[block].v + kBlockRows * k)[l] * x[block].v[k];
      }
    }
  }
  for (int l = 0; l < kLanes; ++l) lanes(y.v)[l] = sum[l];
}

/// Products A' x of several blocks, summed by column in four parts that are added up at the end, in
/// one order whatever the width of the vectors.
struct TransposedSum {
  static constexpr int kParts = 4 / kPackLanes;
  static constexpr int kPacks = kBlockRows / kPackLanes;
  Pack part[kTangentDim][kParts];

  UNISIM_ALWAYS_INLINE void clear() {
    for (int k = 0; k < kTangentDim; ++k) {
      for (int p = 0; p < kParts; ++p) part[k][p] = Pack{};
    }
  }
  UNISIM_ALWAYS_INLINE void add(const Block& A, const BlockVector& x) {
    for (int k = 0; k < kTangentDim; ++k) {
      const double* a = A.v + kBlockRows * k;
      for (int p = 0; p < kPacks; ++p) part[k][p % kParts] += packs(a)[p] * packs(x.v)[p];
    }
  }
  UNISIM_ALWAYS_INLINE void subtract_from(BlockVector& y) const {
    for (int k = 0; k < kTangentDim; ++k) {
      const double* s = reinterpret_cast<const double*>(part[k]);
      y.v[k] -= (s[0] + s[2]) + (s[1] + s[3]);
    }
  }
};

/// x := L^-1 x for an inverse of invert_factor().
UNISIM_ALWAYS_INLINE void solve_lower(const Block& L_inverse, BlockVector& x) {
  BlockVector y = {};
  TransposedSum sum;
  sum.clear();
  sum.add(L_inverse, x);
  sum.subtract_from(y);
  for (int l = 0; l < kLanes; ++l) lanes(x.v)[l] = -lanes(y.v)[l];
}

/// x := L'^-1 x for an inverse of invert_factor().
UNISIM_ALWAYS_INLINE void solve_lower_transposed(const Block& L_inverse, BlockVector& x) {
  Lane y[kLanes];
  for (int l = 0; l < kLanes; ++l) y[l] = lanes(L_inverse.v)[l] * x.v[0];
  for (int k = 1; k < kTangentDim; ++k) {
    for (int l = 0; l < kLanes; ++l) y[l] += lanes(L_inverse.v + kBlockRows * k)[l] * x.v[k];
  }
  for (int l = 0; l < kLanes; ++l) lanes(x.v)[l] = y[l];
}

}  // namespace UNISIM_ISA
}  // namespace unisim
