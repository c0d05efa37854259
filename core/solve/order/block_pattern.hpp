// SPDX-License-Identifier: MIT
// Where the blocks of the normal equations lie: nodes to columns, edges to slots.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/status.hpp"
#include "core/graph/graph.hpp"
#include "core/solve/solver_capacity.hpp"

namespace unisim {

/// Where an edge adds its off-diagonal block.
struct EdgeSlot {
  int32_t slot = -1;        ///< off-diagonal block of H; -1: an end is fixed
  bool a_is_later = false;  ///< the block's rows are those of node a, else of node b
};

/// The part of an elimination order that stays when the rest of it is made anew: the columns that
/// have nothing new below them in the elimination tree.
struct KeptOrder {
  Span<const int32_t> columns;    ///< by their former numbers, ascending; they come first again
  Span<const int32_t> row_start;  ///< one more than supernodes among them
  Span<int32_t> rows;  ///< of L below each supernode; [in] former, [out] new column numbers
};

/// Block structure of H = sum J' W J for the free nodes of a graph.
///
///     column j ->  0   1   2   3        the lower triangle is stored: diagonal blocks by column,
///     row 0      [ D0              ]    off-diagonal blocks in column order, rows ascending:
///     row 1      [ .   D1          ]      column_start = 0 1 2 3 3
///     row 2      [ s0  .   D2      ]      row          = 2 3 3
///     row 3      [ .   s1  s2  D3  ]    (slots s0 s1 s2)
///
/// Columns are in elimination order. All work is linear in nodes, edges and pairs but the ordering.
class BlockPattern {
 public:
  BlockPattern() = default;
  BlockPattern(Arena& arena, const SolverCapacity& capacity);

  /// Read the structure of a graph and order its free nodes by minimum degree.
  /// @return kOk; kCapacity when nodes, edges or pairs exceed the declared ones; kNotReady without
  /// a free node
  Status build(const Graph& graph);
  /// The same after a change of the graph: `kept` columns keep their order, the others are ordered
  /// behind them by minimum degree.
  /// @return as build(); kNotReady also when the rest is too entangled to be ordered apart: build()
  Status rebuild(const Graph& graph, const KeptOrder& kept);

  /// Whether skeleton nodes count as fixed, from the next build() on.
  void hold_skeleton(bool hold) { holds_skeleton_ = hold; }
  bool holds_skeleton() const { return holds_skeleton_; }

  int32_t columns() const { return columns_; }
  int32_t pairs() const { return pairs_; }
  /// Column of a node, -1 when it is fixed or not there.
  int32_t column_of_node(int32_t node) const { return column_of_node_[node]; }
  int32_t node_of_column(int32_t column) const { return node_of_column_[column]; }
  EdgeSlot edge_slot(int32_t edge) const { return edge_slot_[edge]; }
  /// The edges, those of the first column first, each with the first of its columns; behind them
  /// those between fixed nodes.
  Span<const int32_t> edges() const { return edges_.subspan(0, edge_count_); }
  /// columns() + 1 offsets into rows().
  Span<const int32_t> column_start() const { return {column_start_.data(), columns_ + 1}; }
  /// pairs() row indices.
  Span<const int32_t> rows() const { return {row_.data(), pairs_}; }

 private:
  void number_nodes(const Graph& graph);
  void number_rest(const Graph& graph);
  void number_kept_first(const Graph& graph, const KeptOrder& kept);
  bool order_rest(const KeptOrder& kept);
  Status collect_pairs(const Graph& graph);
  void order_columns();
  void place_pairs(const Graph& graph);
  void sort_edges(const Graph& graph);

  SolverCapacity capacity_;
  bool holds_skeleton_ = false;
  int32_t columns_ = 0;
  int32_t first_late_ = 0;  // column, before ordering
  int32_t pairs_ = 0;
  int32_t edge_count_ = 0;
  Span<int32_t> column_of_node_;
  Span<int32_t> node_of_column_;
  Span<EdgeSlot> edge_slot_;
  Span<int32_t> edges_;
  Span<int32_t> column_start_;
  Span<int32_t> row_;
  Span<int32_t> pair_a_;  // column numbers of each pair, smaller one first, before ordering
  Span<int32_t> pair_b_;
  Span<int32_t> pair_of_edge_;
  Span<int32_t> adjacency_start_;
  Span<int32_t> adjacency_;
  Span<int32_t> order_;  // new column -> old column
  Span<int32_t> work_;
};

}  // namespace unisim
