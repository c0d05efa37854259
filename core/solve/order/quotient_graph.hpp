// SPDX-License-Identifier: MIT
// Quotient graph: eliminates the nodes of a graph by minimum degree without storing the fill.
#pragma once

#include <cstdint>

#include "core/base/span.hpp"

namespace unisim {

/// Graph of two kinds of members. A variable is a node not yet eliminated; an element is an
/// eliminated node and stands for the clique of the variables it touched. The neighbours of a
/// variable are its remaining variables and those of its elements, so eliminating a node never
/// stores the fill it makes. After Amestoy, Davis and Duff, "An approximate minimum degree ordering
/// algorithm", SIAM J. Matrix Anal. Appl. 17 (1996).
class QuotientGraph {
 public:
  /// Arguments as of minimum_degree_order(); `work` is used until the object ends.
  QuotientGraph(Span<const int32_t> adjacency_start, Span<const int32_t> adjacency,
                int32_t first_late, Span<int32_t> work);
  /// Eliminate every node, one of least degree at a time, late ones after all others.
  void eliminate_all();
  /// The nodes in an order of that elimination, once.
  void write_order(Span<int32_t> order);

 private:
  static constexpr int32_t kNone = -1;

  Span<int32_t> take(int32_t count);
  void push_degree(int32_t i);
  void remove_degree(int32_t i);
  int32_t pop_minimum();
  void make_room(int32_t needed);
  int32_t gather_element(int32_t me);
  void absorb(int32_t e, int32_t into);
  void measure_elements(int32_t me);
  int32_t prune_variables(int32_t me);
  void prune_variable(int32_t i, int32_t me, int32_t* eliminated);
  void merge_twins(int32_t me);
  bool is_late(int32_t i) const { return i >= first_late_; }
  bool may_go(int32_t i) const { return late_may_go_ || !is_late(i); }
  void release_late();
  bool are_twins(int32_t i, int32_t j);
  void merge(int32_t j, int32_t into);
  void finish_element(int32_t me, int32_t left);

  int32_t n_;
  int32_t first_late_;
  Span<int32_t> work_;
  int32_t taken_ = 0;
  Span<int32_t> start_;     // list of a member: elements first, then variables
  Span<int32_t> length_;    // of the list
  Span<int32_t> elements_;  // how many of the list are elements
  Span<int32_t> weight_;    // variables it stands for; 0: gone; negative: in the present element
  Span<int32_t> degree_;    // bound on the weight of a variable's neighbours; weight of an element
  Span<int32_t> stamp_;     // marks and set differences, compared with mark_
  Span<int32_t> head_;      // degree -> first variable of that degree that may be eliminated
  Span<int32_t> next_;      // in the degree list or in the hash list
  Span<int32_t> previous_;  // in the degree list; the hash while in a hash list
  Span<int32_t> hash_head_;
  Span<int32_t> parent_;     // element that absorbed an element
  Span<int32_t> twin_next_;  // chain of the variables a member stands for
  Span<int32_t> twin_last_;
  Span<int32_t> list_;
  int32_t list_end_ = 0;
  int32_t minimum_ = 0;
  int32_t mark_ = 1;
  int32_t largest_ = 0;
  int32_t eliminated_ = 0;
  bool late_may_go_ = false;
};

}  // namespace unisim
