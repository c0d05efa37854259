// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation with 7x7 blocks.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/status.hpp"
#include "core/solve/block.hpp"
#include "core/solve/solver_capacity.hpp"

namespace unisim {

/// Lower triangle of a symmetric block matrix, laid out as in BlockPattern.
struct BlockMatrixView {
  Span<const int32_t> column_start;  ///< columns + 1
  Span<const int32_t> rows;          ///< row of each off-diagonal block, > its column
  Span<const Block> diagonal;        ///< columns
  Span<const Block> off_diagonal;    ///< as rows
};

/// H + lambda diag(H) = L L', left-looking, in the column order of H.
///
/// analyze() once per structure, factorize() once per matrix, solve() as often as wanted.
class BlockCholesky {
 public:
  BlockCholesky() = default;
  BlockCholesky(Arena& arena, const SolverCapacity& capacity);

  /// Elimination tree and column structures of L.
  /// @return kOk; kCapacity when L has more blocks than declared: needed_blocks() says how many
  Status analyze(Span<const int32_t> column_start, Span<const int32_t> rows);

  /// Blocks of L, diagonal included, for the structure last handed to analyze().
  int64_t needed_blocks() const { return needed_blocks_; }

  /// Numeric factorisation of H + lambda diag(H), same structure as analyzed.
  /// @return kOk; kNumerical when a pivot is not positive or not finite: bad_column() says where,
  /// and
  ///         there is no factor until the next success
  Status factorize(const BlockMatrixView& H, double lambda);

  /// Column of the pivot that made factorize() fail, -1 after a success.
  int32_t bad_column() const { return bad_column_; }

  /// x := (L L')^-1 x. Needs a factor.
  void solve(Span<BlockVector> x) const;

 private:
  bool find_structure(Span<const int32_t> column_start, Span<const int32_t> rows);
  void load_column(const BlockMatrixView& H, double lambda, int32_t column);
  void update_column(int32_t column);
  bool finish_column(const BlockMatrixView& H, double lambda, int32_t column);
  void enlist(int32_t column, int32_t position);

  int32_t columns_ = 0;
  int64_t needed_blocks_ = 0;
  int32_t bad_column_ = -1;
  Span<int32_t> start_;  // columns + 1 offsets into rows_ and off_diagonal_
  Span<int32_t> rows_;   // rows of L below the diagonal, ascending in each column
  Span<Block> diagonal_;
  Span<Block> off_diagonal_;
  Span<int32_t> next_;  // children lists in analysis; lists of columns waiting for a row later
  Span<int32_t> first_;
  Span<int32_t> position_;  // next row of a waiting column
  Span<int32_t> place_;     // row -> place in the present column
};

}  // namespace unisim
