// SPDX-License-Identifier: MIT
// Storage of one 7x7 block for the vector unit.
#pragma once

#include <Eigen/Core>

#include "core/base/eigen_types.hpp"

namespace unisim {

/// Rows of a stored column: 7 and one of padding, always zero, so that a column is a cache line.
inline constexpr int kBlockRows = 8;

/// 7x7 matrix, column-major, 8 rows each.
struct alignas(64) Block {
  double v[kBlockRows * kTangentDim];

  double& at(int row, int column) { return v[column * kBlockRows + row]; }
  double at(int row, int column) const { return v[column * kBlockRows + row]; }
};
static_assert(sizeof(Block) == 448, "seven cache lines");

/// Seven numbers and one of padding.
struct alignas(64) BlockVector {
  double v[kBlockRows];
};

/// The 7x7 part as an Eigen matrix.
using BlockMap = Eigen::Map<Eigen::Matrix<double, 7, 7>, Eigen::Unaligned, Eigen::OuterStride<8>>;
using ConstBlockMap =
    Eigen::Map<const Eigen::Matrix<double, 7, 7>, Eigen::Unaligned, Eigen::OuterStride<8>>;
inline BlockMap as_matrix(Block& block) { return BlockMap(block.v); }
inline ConstBlockMap as_matrix(const Block& block) { return ConstBlockMap(block.v); }

}  // namespace unisim
