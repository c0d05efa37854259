// SPDX-License-Identifier: MIT
// A stored block as an Eigen matrix.
#pragma once

#include "core/base/eigen_types.hpp"
#include "core/solve/factor/block.hpp"

namespace unisim {

using BlockMap = Eigen::Map<Eigen::Matrix<double, 7, 7>, Eigen::Unaligned, Eigen::OuterStride<8>>;
using ConstBlockMap =
    Eigen::Map<const Eigen::Matrix<double, 7, 7>, Eigen::Unaligned, Eigen::OuterStride<8>>;
/// The 7x7 part.
inline BlockMap as_matrix(Block& block) { return BlockMap(block.v); }
inline ConstBlockMap as_matrix(const Block& block) { return ConstBlockMap(block.v); }

}  // namespace unisim
