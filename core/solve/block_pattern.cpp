// SPDX-License-Identifier: MIT
// Where the blocks of the normal equations lie.
#include "core/solve/block_pattern.hpp"

#include <algorithm>

#include "core/solve/ordering.hpp"

namespace unisim {
namespace {

int32_t work_size(const SolverCapacity& c) {
  const int64_t ordering = minimum_degree_workspace(c.nodes, c.pairs);
  const int64_t buckets = c.edges + 2 * static_cast<int64_t>(c.nodes) + 1;
  return static_cast<int32_t>(std::max(ordering, buckets));
}

// counts[k + 1] holds the size of bucket k; afterwards counts[k] is its offset.
void to_offsets(Span<int32_t> counts) {
  for (int32_t k = 1; k < counts.size(); ++k) counts[k] += counts[k - 1];
}

}  // namespace

BlockPattern::BlockPattern(Arena& arena, const SolverCapacity& capacity)
    : capacity_(capacity),
      column_of_node_(arena.take<int32_t>(capacity.nodes)),
      node_of_column_(arena.take<int32_t>(capacity.nodes)),
      edge_slot_(arena.take<EdgeSlot>(capacity.edges)),
      column_start_(arena.take<int32_t>(capacity.nodes + 1)),
      row_(arena.take<int32_t>(capacity.pairs)),
      pair_a_(arena.take<int32_t>(capacity.pairs)),
      pair_b_(arena.take<int32_t>(capacity.pairs)),
      pair_of_edge_(arena.take<int32_t>(capacity.edges)),
      adjacency_start_(arena.take<int32_t>(capacity.nodes + 1)),
      adjacency_(arena.take<int32_t>(2 * capacity.pairs)),
      order_(arena.take<int32_t>(capacity.nodes)),
      work_(arena.take<int32_t>(work_size(capacity))) {}

Status BlockPattern::build(const Graph& graph) {
  if (graph.node_end() > capacity_.nodes || graph.edge_end() > capacity_.edges) {
    return Status::kCapacity;
  }
  number_nodes(graph);
  if (columns_ == 0) return Status::kNotReady;
  const Status status = collect_pairs(graph);
  if (!is_ok(status)) return status;
  order_columns();
  place_pairs(graph);
  return Status::kOk;
}

void BlockPattern::number_nodes(const Graph& graph) {
  columns_ = 0;
  for (int32_t id = 0; id < graph.node_end(); ++id) {
    const Node& node = graph.node(id);
    const bool free = node.alive && !node.fixed;
    column_of_node_[id] = free ? columns_ : -1;
    if (free) node_of_column_[columns_++] = id;
  }
}

// Edges are put in buckets by their smaller column, so that edges of one pair meet in one bucket.
Status BlockPattern::collect_pairs(const Graph& graph) {
  const Span<int32_t> offset = work_.subspan(0, columns_ + 1);
  const Span<int32_t> pair_with = work_.subspan(columns_ + 1, columns_);  // other column -> pair
  const Span<int32_t> bucket = work_.subspan(2 * columns_ + 1, graph.edge_end());
  const auto ends = [&](int32_t id, int32_t* low, int32_t* high) {
    const Edge& edge = graph.edge(id);
    if (!edge.alive) return false;
    const int32_t a = column_of_node_[edge.a];
    const int32_t b = column_of_node_[edge.b];
    *low = std::min(a, b);
    *high = std::max(a, b);
    return *low >= 0;
  };
  int32_t low = 0;
  int32_t high = 0;
  offset.fill(0);
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    if (ends(id, &low, &high)) ++offset[low + 1];
  }
  to_offsets(offset);
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    pair_of_edge_[id] = -1;
    if (ends(id, &low, &high)) bucket[offset[low]++] = id;
  }
  pairs_ = 0;
  pair_with.fill(-1);
  int32_t at = 0;
  for (int32_t column = 0; column < columns_; ++column) {
    const int32_t first_pair = pairs_;
    for (; at < offset[column]; ++at) {  // the offsets have moved to the ends of their buckets
      ends(bucket[at], &low, &high);
      if (pair_with[high] < first_pair) {
        if (pairs_ == capacity_.pairs) return Status::kCapacity;
        pair_a_[pairs_] = low;
        pair_b_[pairs_] = high;
        pair_with[high] = pairs_++;
      }
      pair_of_edge_[bucket[at]] = pair_with[high];
    }
  }
  return Status::kOk;
}

void BlockPattern::order_columns() {
  const Span<int32_t> start = adjacency_start_.subspan(0, columns_ + 1);
  start.fill(0);
  for (int32_t p = 0; p < pairs_; ++p) {
    ++start[pair_a_[p] + 1];
    ++start[pair_b_[p] + 1];
  }
  to_offsets(start);
  const Span<int32_t> fill = work_.subspan(0, columns_);
  for (int32_t c = 0; c < columns_; ++c) fill[c] = start[c];
  for (int32_t p = 0; p < pairs_; ++p) {
    adjacency_[fill[pair_a_[p]]++] = pair_b_[p];
    adjacency_[fill[pair_b_[p]]++] = pair_a_[p];
  }
  minimum_degree_order(start, adjacency_.subspan(0, 2 * pairs_), work_,
                       order_.subspan(0, columns_));
}

// Pairs are sorted by row, then stably by column: rows ascend within each column.
void BlockPattern::place_pairs(const Graph& graph) {
  const Span<int32_t> position = adjacency_start_.subspan(0, columns_);  // old column -> new
  const Span<int32_t> offset = work_.subspan(0, columns_ + 1);
  const Span<int32_t> by_row = adjacency_.subspan(0, pairs_);
  const Span<int32_t> slot_of_pair = adjacency_.subspan(pairs_, pairs_);
  for (int32_t c = 0; c < columns_; ++c) position[order_[c]] = c;
  const Span<int32_t> starts = column_start_.subspan(0, columns_ + 1);
  offset.fill(0);
  starts.fill(0);
  for (int32_t p = 0; p < pairs_; ++p) {
    const int32_t a = position[pair_a_[p]];
    const int32_t b = position[pair_b_[p]];
    pair_a_[p] = std::min(a, b);
    pair_b_[p] = std::max(a, b);
    ++offset[pair_b_[p] + 1];
    ++starts[pair_a_[p] + 1];
  }
  to_offsets(offset);
  to_offsets(starts);
  for (int32_t p = 0; p < pairs_; ++p) by_row[offset[pair_b_[p]]++] = p;
  for (int32_t c = 0; c < columns_; ++c) offset[c] = starts[c];
  for (const int32_t p : by_row) {
    const int32_t slot = offset[pair_a_[p]]++;
    slot_of_pair[p] = slot;
    row_[slot] = pair_b_[p];
  }
  for (int32_t id = 0; id < graph.node_end(); ++id) {
    if (column_of_node_[id] >= 0) column_of_node_[id] = position[column_of_node_[id]];
    if (column_of_node_[id] >= 0) node_of_column_[column_of_node_[id]] = id;
  }
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const int32_t pair = pair_of_edge_[id];
    edge_slot_[id] = EdgeSlot();
    if (pair < 0) continue;
    const Edge& edge = graph.edge(id);
    edge_slot_[id] = {slot_of_pair[pair], column_of_node_[edge.a] > column_of_node_[edge.b]};
  }
}

}  // namespace unisim
