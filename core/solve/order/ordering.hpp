// SPDX-License-Identifier: MIT
// Elimination order of a symmetric block pattern by minimum degree.
#pragma once

#include <cstdint>

#include "core/base/span.hpp"

namespace unisim {

/// int32 of workspace minimum_degree_order() needs.
constexpr int64_t minimum_degree_workspace(int64_t nodes, int64_t pairs) {
  return 2 * pairs + 14 * nodes;
}

/// Order the nodes of an undirected graph so that Cholesky factorisation in this order fills
/// little: minimum degree on the quotient graph with approximate external degrees, element
/// absorption and merging of indistinguishable nodes, then put in postorder. Deterministic.
///
/// @param adjacency_start nodes + 1 offsets into adjacency
/// @param adjacency       neighbours of each node, both directions, no self loops, no doubles
/// @param first_late      nodes from this one on come after all others in the elimination tree
/// @param work            at least minimum_degree_workspace() elements
/// @param[out] order      order[k] is the k-th node to eliminate
void minimum_degree_order(Span<const int32_t> adjacency_start, Span<const int32_t> adjacency,
                          int32_t first_late, Span<int32_t> work, Span<int32_t> order);

}  // namespace unisim
