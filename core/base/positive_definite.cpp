// SPDX-License-Identifier: MIT
// Inverse and solve for symmetric positive definite 7x7 matrices.
#include "core/base/positive_definite.hpp"

#include <cmath>
#include <limits>

namespace unisim {
namespace {

constexpr int kDim = kTangentDim;

/// Lower triangle of L in A = L L', in the diagonal 1 / L(i, i).
struct Factor {
  double v[kDim][kDim];
};

bool factorize(const Mat7& A, Factor* L) {
  for (int j = 0; j < kDim; ++j) {
    for (int i = j; i < kDim; ++i) {
      double sum = A(i, j);
      for (int k = 0; k < j; ++k) sum -= L->v[i][k] * L->v[j][k];
      if (i > j) {
        L->v[i][j] = sum * L->v[j][j];
      } else if (sum > 0 && std::isfinite(sum)) {
        L->v[j][j] = 1.0 / std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  return true;
}

/// x := L^-1 x, whose first `first` elements are 0.
void solve_lower(const Factor& L, int first, double* x) {
  for (int i = first; i < kDim; ++i) {
    for (int k = first; k < i; ++k) x[i] -= L.v[i][k] * x[k];
    x[i] *= L.v[i][i];
  }
}

/// x := L'^-1 x, down to element `last`.
void solve_lower_transposed(const Factor& L, int last, double* x) {
  for (int i = kDim - 1; i >= last; --i) {
    for (int k = i + 1; k < kDim; ++k) x[i] -= L.v[k][i] * x[k];
    x[i] *= L.v[i][i];
  }
}

}  // namespace

bool is_positive_definite(const Mat7& A) {
  Factor L;
  return factorize(A, &L);
}

Mat7 inverse_of_positive(const Mat7& A) {
  Factor L;
  if (!factorize(A, &L)) return Mat7::Constant(std::numeric_limits<double>::quiet_NaN());
  Mat7 inverse;
  for (int j = 0; j < kDim; ++j) {
    double column[kDim] = {};
    column[j] = 1;
    solve_lower(L, j, column);
    solve_lower_transposed(L, j, column);
    for (int i = j; i < kDim; ++i) inverse(i, j) = inverse(j, i) = column[i];
  }
  return inverse;
}

Vec7 solve_positive(const Mat7& A, const Vec7& b) {
  Factor L;
  if (!factorize(A, &L)) return Vec7::Constant(std::numeric_limits<double>::quiet_NaN());
  Vec7 x = b;
  solve_lower(L, 0, x.data());
  solve_lower_transposed(L, 0, x.data());
  return x;
}

}  // namespace unisim
