// SPDX-License-Identifier: MIT
// Condensed loops: a bounded number of chain edges.
#pragma once

#include <cstdint>

#include "core/base/fixed_vector.hpp"
#include "core/graph/chain.hpp"
#include "core/map/map.hpp"
#include "core/skeleton/loop_edge.hpp"
#include "core/skeleton/loop_watch.hpp"

namespace unisim {

/// Put another chain edge in place of one. @return the new edge
int32_t replace_chain(Map& map, int32_t edge, int32_t a, int32_t b, const ChainLink& link);

/// Each has a slot, which its loop submaps know. Those between the same two nodes that say the
/// same are fused.
class LoopEdges {
 public:
  LoopEdges(Arena& arena, int32_t capacity, Map& map, LoopWatch& watch)
      : map_(map), watch_(watch), edges_(arena, capacity) {}

  /// All slots, the free ones included.
  Span<LoopEdge> all() { return edges_.span(); }
  const LoopEdge& operator[](int32_t slot) const { return edges_[slot]; }
  LoopEdge& operator[](int32_t slot) { return edges_[slot]; }
  bool empty() const {
    for (const LoopEdge& loop : edges_) {
      if (loop.edge >= 0) return false;
    }
    return true;
  }
  /// Does this slot hold an edge?
  bool in_use(int32_t slot) const { return slot < edges_.size() && edges_[slot].edge >= 0; }
  bool full() const { return edges_.full() && slot_of(-1) < 0; }
  /// Slot of an edge of the graph. -1: it is no loop's
  int32_t slot_of(int32_t edge) const;

  /// Make the loop part of an edge that says the same. false: there is none
  bool join(int32_t a, int32_t b, const ChainLink& link, Submap* loop);
  /// Give the loop an edge of its own; not when full().
  void add(int32_t a, int32_t b, const ChainLink& link, Submap* loop);
  /// Node a has got the edges of another node: fuse what says the same now.
  void fuse_at(int32_t node);

  /// The slot is free, its edge is gone from the graph or belongs to another slot; its loops
  /// belong to the edge at `into` from now on, or to none (-1).
  void release(int32_t slot, int32_t into);
  /// Take the edge away for good. @return loops that went with it
  int32_t remove(int32_t slot);
  /// remove(), to stay within memory.
  void drop(int32_t slot);
  /// drop() all at a node that is about to go.
  void drop_at(int32_t node);
  /// The edge that can be missed best: a suspended one, else of the two that join most nearly the
  /// same places the less sure, since what it says the other says too.
  /// @param order position in time by node
  /// @return its slot; -1: there are none
  int32_t weakest(Span<const int32_t> order);

  int32_t dropped_loops() const { return dropped_loops_; }

  // ---- saving and loading
  /// Slots and what is known of them.
  void visit(Archive* archive);
  /// Their edges; nodes are there.
  void visit_edges(Archive* archive);

 private:
  int32_t fusible(int32_t a, int32_t b, const ChainLink& link, int32_t but) const;
  void fuse(int32_t slot, const ChainLink& link);

  Map& map_;
  LoopWatch& watch_;
  FixedVector<LoopEdge> edges_;
  int32_t dropped_loops_ = 0;
};

}  // namespace unisim
