// SPDX-License-Identifier: MIT
// Numeric phase of the supernodal block Cholesky factorisation; vectorised.
#include "core/solve/factor/supernodal_factor.hpp"

#include "core/solve/factor/block_kernels.hpp"
#include "core/solve/order/supernode_run.hpp"

namespace unisim {
namespace UNISIM_ISA {
namespace {

constexpr double kPivotFloor = 1e-13;  // of the diagonal element: below it a pivot is roundoff

void damp(const Run& J, double lambda, BlockVector* H_diagonal, Block* L) {
  for (int32_t k = 0; k < J.width; ++k) {
    Block& block = L[J.row_offset(k) + k];
    double* before = H_diagonal[J.first + k].v;
    for (int d = 0; d < kTangentDim; ++d) {
      before[d] = block.at(d, d);
      block.at(d, d) *= 1.0 + lambda;
    }
  }
}

void find_places(const Run& J, int32_t* place) {
  for (int32_t k = 0; k < J.width; ++k) place[J.first + k] = k;
  for (int32_t r = 0; r < J.row_count; ++r) place[J.rows[r]] = J.width + r;
}

// Subtracts what run K contributes to run J: its rows from `at` on, of which those before `end_at`
// are columns of J.
void update(const Run& J, const Run& K, int32_t at, int32_t end_at, const int32_t* place,
            Block* L) {
  const Block* below = L + K.offset + triangle(K.width);
  for (int32_t q = at; q < end_at; ++q) {
    const int32_t k = place[K.rows[q]];
    const Block* B = below + q * K.width;
    subtract_grams(L[J.row_offset(k) + k], B, K.width);
    for (int32_t p = q + 1; p < K.row_count; ++p) {
      subtract_products(L[J.row_offset(place[K.rows[p]]) + k], below + p * K.width, B, K.width);
    }
  }
}

// Factorises the run's own columns. @return the column that failed, -1 if none
int32_t finish(const Run& J, double lambda, const BlockVector* H_diagonal, Block* L) {
  const int32_t row_end = J.row_end();
  for (int32_t k = 0; k < J.width; ++k) {
    const Block* own = L + J.row_offset(k);
    Block& diagonal = L[J.row_offset(k) + k];
    subtract_grams(diagonal, own, k);
    double floor[kTangentDim];
    for (int d = 0; d < kTangentDim; ++d) {
      floor[d] = kPivotFloor * (1.0 + lambda) * H_diagonal[J.first + k].v[d];
    }
    if (!invert_factor(diagonal, floor)) return J.first + k;
    for (int32_t row = k + 1; row < row_end; ++row) {
      Block* blocks = L + J.row_offset(row);
      subtract_products(blocks[k], blocks, own, k);
      solve_right(blocks[k], diagonal);
    }
  }
  return -1;
}

// Run s waits for the supernode that holds its row at `position`.
void enlist(const Supernodes& S, const SupernodeLists& lists, int32_t s, int32_t position) {
  if (position == S.row_start[s + 1] - S.row_start[s]) return;
  const int32_t target = S.of_column[S.rows[S.row_start[s] + position]];
  lists.position[s] = position;
  lists.next[s] = lists.first[target];
  lists.first[target] = s;
}

void update_from_list(const FactorTask& task, int32_t s) {
  const SupernodeLists& lists = task.lists;
  const Run J(task.S, s);
  const int32_t column_end = J.first + J.width;
  for (int32_t k = lists.first[s]; k != -1;) {
    const int32_t following = lists.next[k];
    const Run K(task.S, k);
    const int32_t at = lists.position[k];
    int32_t end_at = at + 1;
    while (end_at < K.row_count && K.rows[end_at] < column_end) ++end_at;
    update(J, K, at, end_at, lists.place, task.blocks);
    enlist(task.S, lists, k, end_at);
    k = following;
  }
}

// The first row of a run whose column is that stale: all later ones are, too.
int32_t first_row(const FactorTask& task, const Run& J, Staleness least) {
  int32_t r = 0;
  while (r < J.row_count && task.stale[task.S.of_column[J.rows[r]]] < least) ++r;
  return r;
}

// What the run's part of x takes from its rows, beginning with row `first`.
void forward_rows(const Run& J, int32_t first, const Block* L, BlockVector* x) {
  const Block* below = L + J.row_offset(J.width);
  for (int32_t r = first; r < J.row_count; ++r) {
    subtract_times(x[J.rows[r]], below + r * J.width, x + J.first, J.width);
  }
}

void forward_run(const Run& J, const Block* L, BlockVector* x) {
  BlockVector* own = x + J.first;
  for (int32_t k = 0; k < J.width; ++k) {
    const Block* row = L + J.row_offset(k);
    subtract_times(own[k], row, own, k);
    solve_lower(row[k], own[k]);
  }
  forward_rows(J, 0, L, x);
}

void backward_run(const Run& J, const Block* L, BlockVector* x) {
  BlockVector* own = x + J.first;
  const Block* below = L + J.row_offset(J.width);
  for (int32_t k = J.width - 1; k >= 0; --k) {
    TransposedSum sum;
    sum.clear();
    for (int32_t r = 0; r < J.row_count; ++r) sum.add(below[r * J.width + k], x[J.rows[r]]);
    for (int32_t row = k + 1; row < J.width; ++row) sum.add(L[J.row_offset(row) + k], own[row]);
    sum.subtract_from(own[k]);
    solve_lower_transposed(L[J.row_offset(k) + k], own[k]);
  }
}

}  // namespace

int32_t factorize_supernodes(const FactorTask& task) {
  const Supernodes& S = task.S;
  for (int32_t s = 0; s < S.count; ++s) task.lists.first[s] = -1;
  for (int32_t s = 0; s < S.count; ++s) {
    const Run J(S, s);
    if (task.stale[s] == Staleness::kFactor) {
      damp(J, task.lambda, task.H_diagonal, task.blocks);
      find_places(J, task.lists.place);
      update_from_list(task, s);
      const int32_t failed = finish(J, task.lambda, task.H_diagonal, task.blocks);
      if (failed >= 0) return failed;
      enlist(S, task.lists, s, 0);
    } else {
      enlist(S, task.lists, s, first_row(task, J, Staleness::kFactor));
    }
    if (task.x == nullptr) continue;
    if (task.stale[s] == Staleness::kNone) {
      forward_rows(J, first_row(task, J, Staleness::kRightSide), task.blocks, task.x);
    } else {
      forward_run(J, task.blocks, task.x);
    }
  }
  return -1;
}

void forward_supernodes(const Supernodes& S, const Block* L, int32_t begin, int32_t end,
                        BlockVector* x) {
  for (int32_t s = begin; s < end; ++s) forward_run(Run(S, s), L, x);
}

void backward_supernodes(const Supernodes& S, const Block* L, int32_t begin, int32_t end,
                         BlockVector* x) {
  for (int32_t s = end - 1; s >= begin; --s) backward_run(Run(S, s), L, x);
}

}  // namespace UNISIM_ISA
}  // namespace unisim
