// SPDX-License-Identifier: MIT
// Declared sizes of a solver.
#pragma once

#include <cstdint>

namespace unisim {

/// Largest problem a solver takes. Memory is about 1.2 kB per node, 12 bytes per edge, 0.48 kB per
/// pair pair and 0.45 kB per factor block.
struct SolverCapacity {
  int32_t nodes = 0;          ///< as in GraphCapacity
  int32_t edges = 0;          ///< as in GraphCapacity
  int32_t pairs = 0;          ///< pairs of nodes joined by at least one edge; at most edges
  int32_t factor_blocks = 0;  ///< 7x7 blocks of the Cholesky factor, diagonal included
};

/// Factor blocks that suffice for any graph of this many nodes.
constexpr int64_t dense_factor_blocks(int32_t nodes) {
  return static_cast<int64_t>(nodes) * (nodes + 1) / 2;
}

}  // namespace unisim
