// SPDX-License-Identifier: MIT
// Blocks of (L L')^-1 on the pattern of L; vectorised.
#include "core/solve/factor/sparse_inverse.hpp"

#include "core/solve/factor/block_kernels.hpp"
#include "core/solve/order/supernode_run.hpp"

namespace unisim {
namespace UNISIM_ISA {
namespace {

UNISIM_ALWAYS_INLINE BlockVector& column_of(Block& block, int column) {
  return reinterpret_cast<BlockVector*>(block.v)[column];
}

/// C := C L^-1 for an inverse of invert_factor().
void multiply_right(Block& C, const Block& L_inverse) {
  UNISIM_UNROLL
  for (int j = 0; j < kTangentDim; ++j) {
    Lane c[kLanes] = {};
    UNISIM_UNROLL
    for (int k = j; k < kTangentDim; ++k) {
      const double factor = L_inverse.v[kBlockRows * k + j];
      for (int l = 0; l < kLanes; ++l) c[l] += lanes(C.v + kBlockRows * k)[l] * factor;
    }
    for (int l = 0; l < kLanes; ++l) lanes(C.v + kBlockRows * j)[l] = c[l];
  }
}

/// Column of L^-T L^-1 for an inverse of invert_factor().
void gram_column(const Block& L_inverse, int column, BlockVector& out) {
  Lane sum[kLanes] = {};
  for (int k = column; k < kTangentDim; ++k) {
    const double* row = L_inverse.v + kBlockRows * k;
    for (int l = 0; l < kLanes; ++l) sum[l] += lanes(row)[l] * row[column];
  }
  for (int l = 0; l < kLanes; ++l) lanes(out.v)[l] = sum[l];
}

/// One column of blocks of run J on its way from L to S: column `c` of each block at a time, so
/// that what is to be multiplied fits beside in vectors.
class InverseColumn {
 public:
  UNISIM_ALWAYS_INLINE InverseColumn(const InverseTask& task, const Run& J, int32_t k)
      : task_(task), J_(J), k_(k), end_(J.row_end()), L_inverse_(at(k)) {}

  void invert() {
    for (int32_t row = k_ + 1; row < end_; ++row) multiply_right(at(row), L_inverse_);
    Block S;
    for (int c = 0; c < kTangentDim; ++c) {
      for (int32_t row = k_ + 1; row < end_; ++row) {
        BlockVector& column = column_of(at(row), c);
        task_.work[row] = column;
        column = BlockVector{};
      }
      multiply(c);
      gram_column(L_inverse_, c, column_of(S, c));
      subtract_inner(c, column_of(S, c));
    }
    for (int c = 1; c < kTangentDim; ++c) {
      for (int row = 0; row < c; ++row) S.at(row, c) = S.at(c, row);
    }
    at(k_) = S;
  }

 private:
  UNISIM_ALWAYS_INLINE Block& at(int32_t row) const {
    return task_.blocks[J_.row_offset(row) + k_];
  }

  // Column c of S_Rj = -S_RR Y, in the order in which the columns of S_RR lie in memory.
  void multiply(int c) const {
    for (int32_t row = k_ + 1; row < end_;) {
      const Run T(task_.S, task_.S.of_column[J_.block_row(row)]);
      find_places(T, row);
      const int32_t column_end = T.first + T.width;
      for (; row < end_ && J_.block_row(row) < column_end; ++row) {
        multiply_column(J_.block_row(row) - T.first, row, c);
      }
    }
  }

  // Where the rows of R from `row` on begin in run T, which holds the first of them as a column.
  void find_places(const Run& T, int32_t row) const {
    int32_t r = 0;
    for (; row < end_; ++row) {
      const int32_t wanted = J_.block_row(row);
      const int32_t column = wanted - T.first;
      if (column >= T.width) {
        while (T.rows[r] != wanted) ++r;
      }
      task_.place[row] = T.row_offset(column < T.width ? column : T.width + r);
    }
  }

  // One column of S_RR times Y, and its mirror image, for only one of the two is stored.
  void multiply_column(int32_t column, int32_t row, int c) const {
    const Block* S = task_.blocks + column;
    const BlockVector& y = task_.work[row];
    BlockVector& out = column_of(at(row), c);
    subtract_times(out, S + task_.place[row], &y, 1);
    TransposedSum sum;
    sum.clear();
    for (int32_t i = row + 1; i < end_; ++i) {
      const Block& block = S[task_.place[i]];
      sum.add(block, task_.work[i]);
      subtract_times(column_of(at(i), c), &block, &y, 1);
    }
    sum.subtract_from(out);
  }

  // Subtracts column c of Y' S_Rj, from its diagonal on: before it Y is overwritten.
  void subtract_inner(int c, BlockVector& out) const {
    TransposedSum sum;
    sum.clear();
    for (int32_t row = k_ + 1; row < end_; ++row) {
      Block& block = at(row);
      const BlockVector S = column_of(block, c);
      column_of(block, c) = task_.work[row];
      sum.add(block, S);
      column_of(block, c) = S;
    }
    sum.subtract_from(out);
  }

  const InverseTask& task_;
  const Run& J_;
  int32_t k_;
  int32_t end_;
  const Block& L_inverse_;
};

}  // namespace

void invert_supernode(const InverseTask& task, int32_t s) {
  const Run J(task.S, s);
  for (int32_t k = J.width - 1; k >= 0; --k) InverseColumn(task, J, k).invert();
}

}  // namespace UNISIM_ISA
}  // namespace unisim
