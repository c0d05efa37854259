// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation with 7x7 blocks.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/status.hpp"
#include "core/solve/block.hpp"
#include "core/solve/solver_capacity.hpp"

namespace unisim {

/// Lower triangle of a symmetric block matrix, laid out as in BlockPattern. Of the diagonal blocks
/// only the lower triangles are read.
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

  /// Elimination tree and column structures of L; time linear in the blocks of L.
  /// @return kOk; kCapacity when H or L has more blocks than declared: needed_blocks() says how
  /// many
  Status analyze(Span<const int32_t> column_start, Span<const int32_t> rows);

  /// Blocks of L, diagonal included, for the structure last handed to analyze().
  int64_t needed_blocks() const { return needed_blocks_; }

  /// Numeric factorisation of H + lambda diag(H), same structure as analyzed.
  /// @return kOk; kNumerical when a pivot is not finite or not above 1e-13 of its diagonal element:
  ///         bad_column() says where, and there is no factor until the next success
  Status factorize(const BlockMatrixView& H, double lambda);

  /// Column of the pivot that made factorize() fail, -1 after a success.
  int32_t bad_column() const { return bad_column_; }

  /// x := (L L')^-1 x. Needs a factor.
  void solve(Span<BlockVector> x) const;

  /// Diagonal block of (L L')^-1; touches only the path from the column to the root of the tree.
  /// @param work columns vectors, overwritten
  void inverse_block(int32_t column, Span<BlockVector> work, Mat7* out);

 private:
  void find_parents(Span<const int32_t> column_start, Span<const int32_t> rows);
  template <class Visit>
  void visit_rows(Visit visit);
  void load_column(const BlockMatrixView& H, double lambda, int32_t column);
  void update_column(int32_t column);
  bool finish_column(int32_t column, const Block& H_diagonal, double lambda);
  void enlist(int32_t column, int32_t position);
  void forward(int32_t column, Span<BlockVector> x) const;
  void backward(int32_t column, Span<BlockVector> x) const;

  SolverCapacity capacity_;
  int32_t columns_ = 0;
  int64_t needed_blocks_ = 0;
  int32_t bad_column_ = -1;
  Span<int32_t> start_;  // columns + 1 offsets into rows_ and off_diagonal_
  Span<int32_t> rows_;   // rows of L below the diagonal, ascending in each column
  Span<Block> diagonal_;
  Span<Block> off_diagonal_;
  Span<int32_t> parent_;     // elimination tree
  Span<int32_t> row_start_;  // H by rows, for the analysis
  Span<int32_t> row_columns_;
  Span<int32_t> first_;     // row -> first column that waits to update it
  Span<int32_t> next_;      // the next one
  Span<int32_t> position_;  // where in such a column that row is
  Span<int32_t> place_;     // row -> place in the present column
};

}  // namespace unisim
