// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation with 7x7 blocks.
#include "core/solve/block_cholesky.hpp"

#include <algorithm>
#include <cstring>

#include "core/solve/block_kernels.hpp"

namespace unisim {
namespace {

constexpr double kPivotFloor = 1e-13;  // of the diagonal element: below it a pivot is roundoff

}  // namespace

BlockCholesky::BlockCholesky(Arena& arena, const SolverCapacity& capacity)
    : capacity_(capacity),
      start_(arena.take<int32_t>(capacity.nodes + 1)),
      rows_(arena.take<int32_t>(std::max(capacity.factor_blocks - 1, 0))),
      diagonal_(arena.take<Block>(capacity.nodes)),
      off_diagonal_(arena.take<Block>(std::max(capacity.factor_blocks - 1, 0))),
      parent_(arena.take<int32_t>(capacity.nodes)),
      row_start_(arena.take<int32_t>(capacity.nodes + 1)),
      row_columns_(arena.take<int32_t>(capacity.pairs)),
      first_(arena.take<int32_t>(capacity.nodes)),
      next_(arena.take<int32_t>(capacity.nodes)),
      position_(arena.take<int32_t>(capacity.nodes)),
      place_(arena.take<int32_t>(capacity.nodes)) {}

// Transposes H's pattern and links each column to the first row below it in L (Liu's algorithm).
void BlockCholesky::find_parents(Span<const int32_t> column_start, Span<const int32_t> rows) {
  const Span<int32_t> ancestor = next_;
  const Span<int32_t> offset = row_start_.subspan(0, columns_ + 1);
  offset.fill(0);
  for (const int32_t row : rows) ++offset[row];
  for (int32_t i = 1; i <= columns_; ++i) offset[i] += offset[i - 1];
  for (int32_t column = columns_ - 1; column >= 0; --column) {
    for (int32_t p = column_start[column]; p < column_start[column + 1]; ++p) {
      row_columns_[--offset[rows[p]]] = column;
    }
  }
  for (int32_t row = 0; row < columns_; ++row) {
    parent_[row] = -1;
    ancestor[row] = -1;
    for (int32_t p = offset[row]; p < offset[row + 1]; ++p) {
      int32_t k = row_columns_[p];
      while (k != -1 && k < row) {
        const int32_t above = ancestor[k];
        ancestor[k] = row;
        if (above == -1) parent_[k] = row;
        k = above;
      }
    }
  }
}

// Calls visit(row, column) for every off-diagonal block of L, rows ascending: row i of L holds the
// tree paths from the columns of row i of H up to i.
template <class Visit>
void BlockCholesky::visit_rows(Visit visit) {
  const Span<int32_t> seen_for = next_;
  for (int32_t row = 0; row < columns_; ++row) {
    seen_for[row] = row;
    for (int32_t p = row_start_[row]; p < row_start_[row + 1]; ++p) {
      for (int32_t k = row_columns_[p]; seen_for[k] != row; k = parent_[k]) {
        visit(row, k);
        seen_for[k] = row;
      }
    }
  }
}

Status BlockCholesky::analyze(Span<const int32_t> column_start, Span<const int32_t> rows) {
  const int32_t columns = column_start.size() - 1;
  if (columns > capacity_.nodes || rows.size() > capacity_.pairs) return Status::kCapacity;
  columns_ = columns;
  bad_column_ = -1;
  find_parents(column_start, rows);
  const Span<int32_t> count = first_.subspan(0, columns_);
  count.fill(0);
  int64_t below = 0;
  visit_rows([&](int32_t, int32_t column) {
    ++count[column];
    ++below;
  });
  needed_blocks_ = below + columns_;
  if (needed_blocks_ > capacity_.factor_blocks) return Status::kCapacity;
  start_[0] = 0;
  for (int32_t j = 0; j < columns_; ++j) start_[j + 1] = start_[j] + count[j];
  for (int32_t j = 0; j < columns_; ++j) count[j] = start_[j];
  visit_rows([&](int32_t row, int32_t column) { rows_[count[column]++] = row; });
  return Status::kOk;
}

Status BlockCholesky::factorize(const BlockMatrixView& H, double lambda) {
  UNISIM_CHECK(H.diagonal.size() == columns_);
  bad_column_ = -1;
  first_.fill(-1);
  for (int32_t j = 0; j < columns_; ++j) {
    load_column(H, lambda, j);
    update_column(j);
    if (!finish_column(j, H.diagonal[j], lambda)) {
      bad_column_ = j;
      return Status::kNumerical;
    }
    enlist(j, start_[j]);
  }
  return Status::kOk;
}

void BlockCholesky::load_column(const BlockMatrixView& H, double lambda, int32_t column) {
  diagonal_[column] = H.diagonal[column];
  for (int d = 0; d < kTangentDim; ++d) diagonal_[column].at(d, d) *= 1.0 + lambda;
  const int32_t begin = start_[column];
  const int32_t end = start_[column + 1];
  for (int32_t p = begin; p < end; ++p) place_[rows_[p]] = p;
  // Both row lists ascend: blocks of L that H lacks start at zero.
  int32_t h = H.column_start[column];
  const int32_t h_end = H.column_start[column + 1];
  for (int32_t p = begin; p < end; ++p) {
    if (h < h_end && H.rows[h] == rows_[p]) {
      off_diagonal_[p] = H.off_diagonal[h++];
    } else {
      std::memset(off_diagonal_[p].v, 0, sizeof(Block));
    }
  }
}

// Subtracts what the earlier columns with a block in row `column` contribute.
void BlockCholesky::update_column(int32_t column) {
  int32_t k = first_[column];
  while (k != -1) {
    const int32_t following = next_[k];
    const int32_t at = position_[k];
    const int32_t end = start_[k + 1];
    const Block* blocks = off_diagonal_.data();
    const Block& B = blocks[at];
    subtract_gram(diagonal_[column], B);
    for (int32_t p = at + 1; p < end; ++p) {
      subtract_product(off_diagonal_[place_[rows_[p]]], blocks[p], B);
    }
    enlist(k, at + 1);
    k = following;
  }
}

bool BlockCholesky::finish_column(int32_t column, const Block& H_diagonal, double lambda) {
  double floor[kTangentDim];
  for (int d = 0; d < kTangentDim; ++d) {
    floor[d] = kPivotFloor * (1.0 + lambda) * H_diagonal.at(d, d);
  }
  Block& L = diagonal_[column];
  if (!factorize_diagonal(L, floor)) return false;
  for (int32_t p = start_[column]; p < start_[column + 1]; ++p) solve_right(off_diagonal_[p], L);
  return true;
}

// Column waits for the row at `position` of its list, its next one to update.
void BlockCholesky::enlist(int32_t column, int32_t position) {
  if (position == start_[column + 1]) return;
  const int32_t row = rows_[position];
  position_[column] = position;
  next_[column] = first_[row];
  first_[row] = column;
}

void BlockCholesky::forward(int32_t column, Span<BlockVector> x) const {
  solve_lower(diagonal_[column], x[column]);
  for (int32_t p = start_[column]; p < start_[column + 1]; ++p) {
    subtract_times(x[rows_[p]], off_diagonal_[p], x[column]);
  }
}

void BlockCholesky::backward(int32_t column, Span<BlockVector> x) const {
  for (int32_t p = start_[column]; p < start_[column + 1]; ++p) {
    subtract_transposed_times(x[column], off_diagonal_[p], x[rows_[p]]);
  }
  solve_lower_transposed(diagonal_[column], x[column]);
}

void BlockCholesky::solve(Span<BlockVector> x) const {
  for (int32_t j = 0; j < columns_; ++j) forward(j, x);
  for (int32_t j = columns_ - 1; j >= 0; --j) backward(j, x);
}

void BlockCholesky::inverse_block(int32_t column, Span<BlockVector> work, Mat7* out) {
  const Span<int32_t> below = position_;  // the path downwards
  for (int32_t j = column; parent_[j] != -1; j = parent_[j]) below[parent_[j]] = j;
  for (int unit = 0; unit < kTangentDim; ++unit) {
    for (int32_t j = column; j != -1; j = parent_[j]) work[j] = BlockVector{};
    work[column].v[unit] = 1.0;
    int32_t root = column;
    for (int32_t j = column; j != -1; j = parent_[j]) {
      forward(j, work);
      root = j;
    }
    for (int32_t j = root; j != column; j = below[j]) backward(j, work);
    backward(column, work);
    for (int row = 0; row < kTangentDim; ++row) (*out)(row, unit) = work[column].v[row];
  }
}

}  // namespace unisim
