// SPDX-License-Identifier: MIT
// Dense kernels on one diagonal block.
#include "core/solve/block_kernels.hpp"

#include <cmath>

namespace unisim {

bool factorize_diagonal(Block& D, const double floor[kTangentDim]) {
  for (int j = 0; j < kTangentDim; ++j) {
    for (int k = 0; k < j; ++k) {
      const double factor = D.at(j, k);
      for (int i = j; i < kTangentDim; ++i) D.at(i, j) -= D.at(i, k) * factor;
    }
    const double pivot = D.at(j, j);
    if (!(pivot > floor[j]) || !std::isfinite(pivot)) return false;
    const double inverse = 1.0 / std::sqrt(pivot);
    D.at(j, j) = inverse;
    for (int i = j + 1; i < kTangentDim; ++i) D.at(i, j) *= inverse;
  }
  return true;
}

void solve_lower(const Block& L, BlockVector& x) {
  for (int j = 0; j < kTangentDim; ++j) {
    x.v[j] *= L.at(j, j);
    for (int i = j + 1; i < kTangentDim; ++i) x.v[i] -= L.at(i, j) * x.v[j];
  }
}

void solve_lower_transposed(const Block& L, BlockVector& x) {
  for (int j = kTangentDim - 1; j >= 0; --j) {
    double sum = x.v[j];
    for (int i = j + 1; i < kTangentDim; ++i) sum -= L.at(i, j) * x.v[i];
    x.v[j] = sum * L.at(j, j);
  }
}

}  // namespace unisim
