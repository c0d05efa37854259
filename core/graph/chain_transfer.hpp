// SPDX-License-Identifier: MIT
// Chain links moved from a node to another it has become rigid with, and fused.
#pragma once

#include "core/graph/chain.hpp"

namespace unisim {

/// Link b -> c as a link a -> c.
/// @param T_a_b      where b lies in a from now on
/// @param covariance of T_a_b, in the tangent of b: what is no longer free is added to the link
ChainLink move_first_end(const ChainLink& link, const Sim3& T_a_b, const Mat7& covariance);

/// Link c -> b as a link c -> a.
ChainLink move_second_end(const ChainLink& link, const Sim3& T_a_b, const Mat7& covariance);

/// Mean of two links between the same nodes, to first order: the sum of their informations.
ChainLink fuse(const ChainLink& one, const ChainLink& other);

/// Square of the whitened difference of two links between the same nodes.
double disagreement_squared(const ChainLink& one, const ChainLink& other);

}  // namespace unisim
