// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation with 7x7 blocks.
#include "core/solve/factor/block_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/solve/factor/sparse_inverse.hpp"
#include "core/solve/factor/supernodal_factor.hpp"
#include "core/solve/order/block_map.hpp"

namespace unisim {

BlockCholesky::BlockCholesky(Arena& arena, const SolverCapacity& capacity)
    : blocks_(arena.take<Block>(capacity.factor_blocks)),
      first_column_(arena.take<int32_t>(capacity.nodes + 1)),
      of_column_(arena.take<int32_t>(capacity.nodes)),
      row_start_(arena.take<int32_t>(capacity.nodes + 1)),
      rows_(arena.take<int32_t>(std::max<int32_t>(capacity.factor_blocks - 1, 0))),
      block_start_(arena.take<int32_t>(capacity.nodes + 1)),
      diagonal_(arena.take<int32_t>(capacity.nodes)),
      off_diagonal_(arena.take<int32_t>(capacity.pairs)),
      stale_(arena.take<Staleness>(capacity.nodes)),
      column_state_(arena.take<ColumnState>(capacity.nodes)),
      fresh_(arena.take<uint8_t>(capacity.nodes)),
      moves_(arena.take<uint8_t>(capacity.nodes)),
      H_diagonal_(arena.take<BlockVector>(capacity.nodes)),
      kept_column_(arena.take<int32_t>(capacity.nodes)),
      kept_width_(arena.take<int32_t>(capacity.nodes)),
      kept_row_start_(arena.take<int32_t>(capacity.nodes + 1)),
      kept_rows_(arena.take<int32_t>(std::max<int32_t>(capacity.factor_blocks - 1, 0))),
      kept_block_start_(arena.take<int32_t>(capacity.nodes)),
      parent_(arena.take<int32_t>(capacity.nodes)),
      H_start_(arena.take<int32_t>(capacity.nodes + 1)),
      H_columns_(arena.take<int32_t>(capacity.pairs)),
      first_(arena.take<int32_t>(capacity.nodes)),
      next_(arena.take<int32_t>(capacity.nodes)),
      position_(arena.take<int32_t>(capacity.nodes)),
      place_(arena.take<int32_t>(capacity.nodes)) {}

// Transposes H's pattern and links each column to the first row below it in L (Liu's algorithm).
void BlockCholesky::find_parents(Span<const int32_t> column_start, Span<const int32_t> rows) {
  const Span<int32_t> ancestor = next_;
  const Span<int32_t> offset = H_start_.subspan(0, columns_ + 1);
  offset.fill(0);
  for (const int32_t row : rows) ++offset[row];
  for (int32_t i = 1; i <= columns_; ++i) offset[i] += offset[i - 1];
  for (int32_t column = columns_ - 1; column >= 0; --column) {
    for (int32_t p = column_start[column]; p < column_start[column + 1]; ++p) {
      H_columns_[--offset[rows[p]]] = column;
    }
  }
  for (int32_t row = 0; row < columns_; ++row) {
    parent_[row] = -1;
    ancestor[row] = -1;
    for (int32_t p = offset[row]; p < offset[row + 1]; ++p) {
      int32_t k = H_columns_[p];
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
    for (int32_t p = H_start_[row]; p < H_start_[row + 1]; ++p) {
      for (int32_t k = H_columns_[p]; seen_for[k] != row; k = parent_[k]) {
        visit(row, k);
        seen_for[k] = row;
      }
    }
  }
}

// Cuts the columns into supernodes: column j joins the run of column j - 1 when it is its parent
// and has the same rows below. Joining columns that differ a little, by blocks of zeros, does not
// pay with blocks of this size. Kept supernodes stay as they are.
void BlockCholesky::choose_supernodes(Span<const int32_t> count, int32_t kept) {
  supernodes_ = 0;
  int32_t j = 0;
  for (; supernodes_ < kept; ++supernodes_) {
    first_column_[supernodes_] = j;
    for (int32_t k = 0; k < kept_width_[supernodes_]; ++k) of_column_[j++] = supernodes_;
  }
  for (const int32_t first = j; j < columns_; ++j) {
    const bool joins = j > first && parent_[j - 1] == j && count[j - 1] == count[j] + 1;
    if (!joins) first_column_[supernodes_++] = j;
    of_column_[j] = supernodes_ - 1;
  }
  first_column_[supernodes_] = columns_;
}

int32_t BlockCholesky::block_count(int32_t s) const { return supernodes().block_count(s); }

// @return false when the blocks do not fit
bool BlockCholesky::place_supernodes(Span<const int32_t> count, int32_t kept) {
  row_start_[0] = 0;
  const Span<int32_t> fill = position_;
  for (int32_t s = 0; s < supernodes_; ++s) {
    row_start_[s + 1] = row_start_[s] + count[first_column_[s + 1] - 1];
    fill[s] = row_start_[s];
  }
  visit_rows([&](int32_t row, int32_t column) {
    const int32_t s = of_column_[column];
    if (column + 1 == first_column_[s + 1]) rows_[fill[s]++] = row;
  });
  int64_t fresh = 0;
  for (int32_t s = kept; s < supernodes_; ++s) fresh += block_count(s);
  int32_t end = 0;
  for (int32_t s = 0; s < kept; ++s) {
    block_start_[s] = kept_block_start_[s];
    end = block_start_[s] + block_count(s);
  }
  if (end + fresh > blocks_.size()) end = pack_kept(kept);
  if (end + fresh > blocks_.size()) return false;
  for (int32_t s = kept; s < supernodes_; ++s) {
    block_start_[s] = end;
    end += block_count(s);
  }
  return true;
}

// Closes the gaps that supernodes which were not kept have left. @return end of the blocks
int32_t BlockCholesky::pack_kept(int32_t kept) {
  int32_t end = 0;
  for (int32_t s = 0; s < kept; ++s) {
    const int32_t count = block_count(s);
    std::memmove(static_cast<void*>(&blocks_[end]), &blocks_[block_start_[s]],
                 static_cast<size_t>(count) * sizeof(Block));
    block_start_[s] = end;
    end += count;
  }
  return end;
}

// The columns above a kept supernode may have a new order among themselves.
void BlockCholesky::sort_kept_rows(int32_t s) {
  const int32_t width = kept_width_[s];
  Block* below = &blocks_[block_start_[s]] + triangle(width);
  int32_t* had = kept_rows_.data() + kept_row_start_[s];
  const int32_t count = row_start_[s + 1] - row_start_[s];
  UNISIM_CHECK(count == kept_row_start_[s + 1] - kept_row_start_[s]);
  for (int32_t r = 0; r < count; ++r) {
    const int32_t wanted = rows_[row_start_[s] + r];
    if (had[r] == wanted) continue;
    int32_t q = r + 1;
    while (q < count && had[q] != wanted) ++q;
    UNISIM_CHECK(q < count);
    std::swap(had[r], had[q]);
    std::swap_ranges(below + r * width, below + (r + 1) * width, below + q * width);
  }
}

KeptOrder BlockCholesky::keep() {
  kept_ = 0;
  int32_t columns = 0;
  kept_row_start_[0] = 0;
  for (int32_t s = 0; s < supernodes_; ++s) {
    if (stale_[s] == Staleness::kFactor) continue;
    kept_width_[kept_] = first_column_[s + 1] - first_column_[s];
    kept_block_start_[kept_] = block_start_[s];
    int32_t to = kept_row_start_[kept_];
    for (int32_t r = row_start_[s]; r < row_start_[s + 1]; ++r) kept_rows_[to++] = rows_[r];
    kept_row_start_[++kept_] = to;
    for (int32_t j = first_column_[s]; j < first_column_[s + 1]; ++j) {
      H_diagonal_[columns] = H_diagonal_[j];
      kept_column_[columns++] = j;
    }
  }
  return {kept_column_.subspan(0, columns), kept_row_start_.subspan(0, kept_ + 1),
          kept_rows_.subspan(0, kept_row_start_[kept_])};
}

Status BlockCholesky::analyze(Span<const int32_t> column_start, Span<const int32_t> rows) {
  return analyze(column_start, rows, 0);
}

Status BlockCholesky::reanalyze(Span<const int32_t> column_start, Span<const int32_t> rows) {
  return analyze(column_start, rows, kept_);
}

Status BlockCholesky::analyze(Span<const int32_t> column_start, Span<const int32_t> rows,
                              int32_t kept) {
  const int32_t columns = column_start.size() - 1;
  if (columns > of_column_.size() || rows.size() > off_diagonal_.size()) return Status::kCapacity;
  columns_ = columns;
  bad_column_ = -1;
  find_parents(column_start, rows);
  const Span<int32_t> count = first_.subspan(0, columns_);
  count.fill(0);
  needed_blocks_ = columns_;
  visit_rows([&](int32_t, int32_t column) {
    ++count[column];
    ++needed_blocks_;
  });
  if (needed_blocks_ > blocks_.size()) return Status::kCapacity;
  choose_supernodes(count, kept);
  if (!place_supernodes(count, kept)) return Status::kCapacity;
  locate_blocks(column_start, rows);
  for (int32_t s = 0; s < kept; ++s) sort_kept_rows(s);
  for (int32_t s = 0; s < supernodes_; ++s) {
    stale_[s] = s < kept ? Staleness::kNone : Staleness::kFactor;
  }
  return Status::kOk;
}

void BlockCholesky::locate_blocks(Span<const int32_t> column_start, Span<const int32_t> rows) {
  for (int32_t s = 0; s < supernodes_; ++s) {
    const int32_t first = first_column_[s];
    const int32_t width = first_column_[s + 1] - first;
    for (int32_t k = 0; k < width; ++k) {
      const int32_t column = first + k;
      diagonal_[column] = block_start_[s] + triangle(k) + k;
      int32_t r = row_start_[s];  // both row lists ascend
      for (int32_t p = column_start[column]; p < column_start[column + 1]; ++p) {
        if (rows[p] < first + width) {
          off_diagonal_[p] = block_start_[s] + triangle(rows[p] - first) + k;
          continue;
        }
        while (rows_[r] != rows[p]) ++r;
        off_diagonal_[p] = block_start_[s] + triangle(width) + (r - row_start_[s]) * width + k;
      }
    }
  }
}

void BlockCholesky::mark_stale(int32_t column, Staleness staleness) {
  for (int32_t s = of_column_[column]; s != -1 && stale_[s] < staleness; s = parent_supernode(s)) {
    stale_[s] = staleness;
  }
}

void BlockCholesky::mark_all_stale() {
  for (int32_t s = 0; s < supernodes_; ++s) stale_[s] = Staleness::kFactor;
}

Assembly BlockCholesky::begin_assembly() {
  for (int32_t j = 0; j < columns_; ++j) {
    const bool stale = stale_[of_column_[j]] == Staleness::kFactor;
    column_state_[j] = stale ? ColumnState::kWanted : ColumnState::kKept;
  }
  return assembly();
}

Assembly BlockCholesky::assembly() {
  return {supernodes(), blocks_.data(), diagonal_.data(), off_diagonal_.data(),
          column_state_.data()};
}

Supernodes BlockCholesky::supernodes() const {
  return {supernodes_,       first_column_.data(), of_column_.data(),
          row_start_.data(), rows_.data(),         block_start_.data()};
}

Status BlockCholesky::factorize(double lambda, Span<BlockVector> x) {
  const Assembly H = assembly();
  for (int32_t j = 0; j < columns_; ++j) H.open(j);  // what no edge has a part in
  FactorTask task;
  task.S = supernodes();
  task.lists = {first_.data(), next_.data(), position_.data(), place_.data()};
  task.stale = stale_.data();
  task.lambda = lambda;
  task.blocks = blocks_.data();
  task.H_diagonal = H_diagonal_.data();
  task.x = x.data();
  bad_column_ = UNISIM_DISPATCH_WIDE(factorize_supernodes(task));
  if (bad_column_ >= 0) {
    mark_all_stale();
    return Status::kNumerical;
  }
  for (int32_t s = 0; s < supernodes_; ++s) {
    fresh_[s] = stale_[s] == Staleness::kNone ? 0 : 1;
    stale_[s] = Staleness::kNone;
  }
  return Status::kOk;
}

void BlockCholesky::backward(Span<BlockVector> x) const {
  UNISIM_DISPATCH_WIDE(backward_supernodes(supernodes(), blocks_.data(), 0, supernodes_, x.data()));
}

void BlockCholesky::backward(Span<BlockVector> x, double least) {
  const Supernodes S = supernodes();
  for (int32_t s = supernodes_ - 1; s >= 0; --s) {
    bool reached = fresh_[s] != 0;
    for (int32_t r = row_start_[s]; !reached && r < row_start_[s + 1]; ++r) {
      reached = moves_[rows_[r]] != 0;
    }
    if (reached) UNISIM_DISPATCH_WIDE(backward_supernodes(S, blocks_.data(), s, s + 1, x.data()));
    for (int32_t j = first_column_[s]; j < first_column_[s + 1]; ++j) {
      if (!reached) x[j] = BlockVector{};
      double largest = 0.0;
      for (const double value : x[j].v) largest = std::max(largest, std::abs(value));
      moves_[j] = largest > least ? 1 : 0;
    }
  }
}

void BlockCholesky::solve(Span<BlockVector> x) const {
  UNISIM_DISPATCH_WIDE(forward_supernodes(supernodes(), blocks_.data(), 0, supernodes_, x.data()));
  backward(x);
}

int32_t BlockCholesky::parent_supernode(int32_t s) const {
  return row_start_[s] == row_start_[s + 1] ? -1 : of_column_[rows_[row_start_[s]]];
}

void BlockCholesky::inverse_block(int32_t column, Span<BlockVector> work, Mat7* out) {
  const InverseTask task = {supernodes(), blocks_.data(), work.data(), place_.data()};
  const Span<int32_t> child = position_;  // the path downwards
  int32_t top = -1;
  for (int32_t s = of_column_[column]; s != -1 && stale_[s] != Staleness::kFactor;
       s = parent_supernode(s)) {
    child[s] = top;
    top = s;
  }
  for (int32_t s = top; s != -1; s = child[s]) {
    UNISIM_DISPATCH_WIDE(invert_supernode(task, s));
    stale_[s] = Staleness::kFactor;
  }
  *out = as_matrix(blocks_[diagonal_[column]]);
}

}  // namespace unisim
