// SPDX-License-Identifier: MIT
// Where the blocks of the normal equations lie.
#include "core/solve/order/block_pattern.hpp"

#include <algorithm>

#include "core/solve/order/ordering.hpp"

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

// Leaves one of each entry in every list and closes the gaps.
void drop_doubles(Span<int32_t> start, Span<int32_t> lists, Span<int32_t> work) {
  const int32_t count = start.size() - 1;
  const Span<int32_t> last_seen_in = work.subspan(0, count);
  last_seen_in.fill(-1);
  int32_t to = 0;
  int32_t from = 0;
  for (int32_t i = 0; i < count; ++i) {
    for (; from < start[i + 1]; ++from) {
      const int32_t j = lists[from];
      if (last_seen_in[j] == i) continue;
      last_seen_in[j] = i;
      lists[to++] = j;
    }
    start[i + 1] = to;
  }
}

}  // namespace

BlockPattern::BlockPattern(Arena& arena, const SolverCapacity& capacity)
    : capacity_(capacity),
      column_of_node_(arena.take<int32_t>(capacity.nodes)),
      node_of_column_(arena.take<int32_t>(capacity.nodes)),
      edge_slot_(arena.take<EdgeSlot>(capacity.edges)),
      edges_(arena.take<int32_t>(capacity.edges)),
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
  column_of_node_.fill(-1);
  number_rest(graph);
}

// What is changed most often comes last, so that little lies above it: where there is a skeleton,
// the nodes that are not of it.
void BlockPattern::number_rest(const Graph& graph) {
  const auto number = [&](bool skeleton) {
    for (int32_t id = 0; id < graph.node_end(); ++id) {
      const Node& node = graph.node(id);
      if (!node.alive || node.fixed || column_of_node_[id] >= 0) continue;
      if ((node.kind == NodeKind::kSkeleton) != skeleton) continue;
      column_of_node_[id] = columns_;
      node_of_column_[columns_++] = id;
    }
  };
  if (!holds_skeleton_) number(true);
  first_late_ = columns_;
  number(false);
}

Status BlockPattern::rebuild(const Graph& graph, const KeptOrder& kept) {
  if (graph.node_end() > capacity_.nodes || graph.edge_end() > capacity_.edges) {
    return Status::kCapacity;
  }
  for (int32_t& row : kept.rows) row = node_of_column_[row];
  number_kept_first(graph, kept);
  if (columns_ == 0) return Status::kNotReady;
  const Status status = collect_pairs(graph);
  if (!is_ok(status)) return status;
  for (int32_t& row : kept.rows) row = column_of_node_[row];
  if (!order_rest(kept)) return Status::kNotReady;
  place_pairs(graph);
  const Span<int32_t> position = work_.subspan(0, columns_);
  for (int32_t c = 0; c < columns_; ++c) position[order_[c]] = c;
  for (int32_t& row : kept.rows) row = position[row];
  return Status::kOk;
}

// Former columns ascend and are at least as high as the new ones, so that the list of their nodes
// is shortened in place.
void BlockPattern::number_kept_first(const Graph& graph, const KeptOrder& kept) {
  columns_ = kept.columns.size();
  for (int32_t i = 0; i < columns_; ++i) node_of_column_[i] = node_of_column_[kept.columns[i]];
  column_of_node_.fill(-1);
  for (int32_t i = 0; i < columns_; ++i) column_of_node_[node_of_column_[i]] = i;
  number_rest(graph);
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
  minimum_degree_order(start, adjacency_.subspan(0, 2 * pairs_), first_late_, work_,
                       order_.subspan(0, columns_));
}

// Eliminating the kept columns has made cliques among the others: the rows below the supernodes
// whose parent is not kept.
bool BlockPattern::order_rest(const KeptOrder& kept) {
  const int32_t first = kept.columns.size();
  const int32_t rest = columns_ - first;
  const Span<int32_t> start = adjacency_start_.subspan(0, rest + 1);
  const auto each_clique = [&](auto&& visit) {
    for (int32_t s = 0; s + 1 < kept.row_start.size(); ++s) {
      const int32_t begin = kept.row_start[s];
      const int32_t size = kept.row_start[s + 1] - begin;
      if (size > 1 && kept.rows[begin] >= first) visit(kept.rows.subspan(begin, size));
    }
  };
  start.fill(0);
  for (int32_t p = 0; p < pairs_; ++p) {
    if (pair_a_[p] < first) continue;
    ++start[pair_a_[p] - first + 1];
    ++start[pair_b_[p] - first + 1];
  }
  int64_t total = 0;
  each_clique([&](Span<const int32_t> clique) {
    for (const int32_t i : clique) start[i - first + 1] += clique.size() - 1;
    total += static_cast<int64_t>(clique.size()) * (clique.size() - 1);
  });
  if (total + 2 * static_cast<int64_t>(pairs_) > adjacency_.size()) return false;
  to_offsets(start);
  const Span<int32_t> fill = work_.subspan(0, rest);
  for (int32_t i = 0; i < rest; ++i) fill[i] = start[i];
  for (int32_t p = 0; p < pairs_; ++p) {
    if (pair_a_[p] < first) continue;
    adjacency_[fill[pair_a_[p] - first]++] = pair_b_[p] - first;
    adjacency_[fill[pair_b_[p] - first]++] = pair_a_[p] - first;
  }
  each_clique([&](Span<const int32_t> clique) {
    for (const int32_t i : clique) {
      for (const int32_t j : clique) {
        if (i != j) adjacency_[fill[i - first]++] = j - first;
      }
    }
  });
  drop_doubles(start, adjacency_, work_);
  const Span<int32_t> order = order_.subspan(first, rest);
  minimum_degree_order(start, adjacency_.subspan(0, start[rest]), first_late_ - first, work_,
                       order);
  for (int32_t& column : order) column += first;
  for (int32_t i = 0; i < first; ++i) order_[i] = i;
  return true;
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
  sort_edges(graph);
}

// In this order the blocks of H are written one behind the other.
void BlockPattern::sort_edges(const Graph& graph) {
  const Span<int32_t> offset = work_.subspan(0, columns_ + 2);
  const auto first_column = [&](const Edge& edge) {
    const int32_t a = column_of_node_[edge.a];
    const int32_t b = column_of_node_[edge.b];
    const int32_t low = std::min(a, b);
    if (low >= 0) return low;
    const int32_t high = std::max(a, b);
    return high >= 0 ? high : columns_;
  };
  offset.fill(0);
  edge_count_ = 0;
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (!edge.alive) continue;
    ++offset[first_column(edge) + 1];
    ++edge_count_;
  }
  to_offsets(offset);
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (edge.alive) edges_[offset[first_column(edge)]++] = id;
  }
}

}  // namespace unisim
