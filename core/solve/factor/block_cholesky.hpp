// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation with 7x7 blocks.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/eigen_types.hpp"
#include "core/base/status.hpp"
#include "core/solve/factor/block.hpp"
#include "core/solve/linearize/assembly.hpp"
#include "core/solve/order/block_pattern.hpp"
#include "core/solve/order/supernodes.hpp"
#include "core/solve/solver_capacity.hpp"

namespace unisim {

/// H + lambda diag(H) = L L', supernodal and left-looking, in the column order of H (best a
/// postorder of the elimination tree: only neighbouring columns can share a supernode).
///
/// analyze() per structure; then, as often as wanted: assemble H into
/// begin_assembly(), factorize(), solve(). L overwrites H. Where only some columns of H have
/// changed, mark_stale() them instead of all: what is not above them in the elimination tree keeps
/// its part of L, even when the structure changes (keep(), reanalyze()).
class BlockCholesky {
 public:
  BlockCholesky() = default;
  BlockCholesky(Arena& arena, const SolverCapacity& capacity);

  /// Elimination tree and supernodes of L; time linear in the blocks of L. All columns are stale.
  /// @param column_start, rows structure of H as in BlockPattern
  /// @return kOk; kCapacity when H or L has more blocks than declared: needed_blocks() says how
  /// many
  Status analyze(Span<const int32_t> column_start, Span<const int32_t> rows);

  /// What of the order and of L stays when the structure changes: all whose H has not. To be
  /// handed to BlockPattern::rebuild(), then to reanalyze(); nothing is factorised between.
  KeptOrder keep();
  /// analyze() after a change of the structure. Kept columns keep their part of L and are not
  /// stale, the others are.
  Status reanalyze(Span<const int32_t> column_start, Span<const int32_t> rows);

  /// Blocks of L, diagonal included, for the structure last handed to analyze().
  int64_t needed_blocks() const { return needed_blocks_; }

  /// H has changed in this column: it and all above it in the tree will be factorised anew. Where
  /// only the right-hand side has, L stays and x is computed anew.
  void mark_stale(int32_t column, Staleness staleness = Staleness::kFactor);
  void mark_all_stale();
  Staleness staleness(int32_t column) const { return stale_[of_column_[column]]; }
  /// Where H is to be put together anew, in stale columns.
  Assembly begin_assembly();

  /// Numeric factorisation of H + lambda diag(H) where it is stale; nothing is stale afterwards.
  /// @return kOk; kNumerical when a pivot is not finite or not above 1e-13 of its diagonal element:
  ///         bad_column() says where; there is no factor then and all columns are stale
  Status factorize(double lambda) { return factorize(lambda, Span<BlockVector>()); }
  /// factorize(), and x := L^-1 x while L is at hand: backward() completes the solution. In columns
  /// that are not stale at all x is the result of the last time already.
  Status factorize(double lambda, Span<BlockVector> x);

  /// Column of the pivot that made factorize() fail, -1 after a success.
  int32_t bad_column() const { return bad_column_; }
  /// The diagonal of H, before damping, of a factorised column.
  const BlockVector& H_diagonal(int32_t column) const { return H_diagonal_[column]; }

  /// x := (L L')^-1 x. Needs a factor.
  void solve(Span<BlockVector> x) const;
  /// x := L'^-1 x. Needs a factor.
  void backward(Span<BlockVector> x) const;
  /// The same, but x is 0 where the last factorize() found nothing stale and no element of x in the
  /// rows below is larger than `least`: a change dies out on its way down the tree.
  void backward(Span<BlockVector> x, double least);

  /// Diagonal block of (L L')^-1. Needs a factor; turns what of it lies between the column and the
  /// root of the tree into the inverse, once: that part is stale then, and solving needs
  /// factorize() again. All columns together cost about three times a factorisation.
  /// @param work columns vectors, overwritten
  void inverse_block(int32_t column, Span<BlockVector> work, Mat7* out);

 private:
  void find_parents(Span<const int32_t> column_start, Span<const int32_t> rows);
  template <class Visit>
  void visit_rows(Visit visit);
  Status analyze(Span<const int32_t> column_start, Span<const int32_t> rows, int32_t kept);
  void choose_supernodes(Span<const int32_t> count, int32_t kept);
  bool place_supernodes(Span<const int32_t> count, int32_t kept);
  int32_t pack_kept(int32_t kept);
  void sort_kept_rows(int32_t s);
  void locate_blocks(Span<const int32_t> column_start, Span<const int32_t> rows);
  Supernodes supernodes() const;
  Assembly assembly();
  int32_t parent_supernode(int32_t s) const;
  int32_t block_count(int32_t s) const;

  int32_t columns_ = 0;
  int32_t supernodes_ = 0;
  int64_t needed_blocks_ = 0;
  int32_t bad_column_ = -1;
  Span<Block> blocks_;
  Span<int32_t> first_column_;  // by supernode, see Supernodes
  Span<int32_t> of_column_;
  Span<int32_t> row_start_;
  Span<int32_t> rows_;
  Span<int32_t> block_start_;
  Span<int32_t> diagonal_;  // see Assembly
  Span<int32_t> off_diagonal_;
  Span<Staleness> stale_;
  Span<ColumnState> column_state_;  // see Assembly
  Span<uint8_t> fresh_;             // stale before the last factorisation, in any way
  Span<uint8_t> moves_;             // column -> an element of x is larger than asked for
  Span<BlockVector> H_diagonal_;
  int32_t kept_ = 0;           // supernodes of the last keep()
  Span<int32_t> kept_column_;  // former numbers of their columns
  Span<int32_t> kept_width_;
  Span<int32_t> kept_row_start_;
  Span<int32_t> kept_rows_;
  Span<int32_t> kept_block_start_;
  Span<int32_t> parent_;   // elimination tree of the columns
  Span<int32_t> H_start_;  // H by rows, for the analysis
  Span<int32_t> H_columns_;
  Span<int32_t> first_;  // see SupernodeLists
  Span<int32_t> next_;
  Span<int32_t> position_;
  Span<int32_t> place_;
};

}  // namespace unisim
