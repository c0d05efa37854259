// SPDX-License-Identifier: MIT
// Elimination order of a symmetric block pattern by minimum degree.
#include "core/solve/order/ordering.hpp"

#include "core/solve/order/quotient_graph.hpp"

namespace unisim {

void minimum_degree_order(Span<const int32_t> adjacency_start, Span<const int32_t> adjacency,
                          int32_t first_late, Span<int32_t> work, Span<int32_t> order) {
  if (order.empty()) return;
  QuotientGraph graph(adjacency_start, adjacency, first_late, work);
  graph.eliminate_all();
  graph.write_order(order);
}

}  // namespace unisim
