// SPDX-License-Identifier: MIT
// Chain factor: a relative pose with a full information matrix, condensed from a part of the map.
#pragma once

#include "core/lie/sim3.hpp"

namespace unisim {

/// What a condensed part of the map says about two of its nodes.
struct ChainLink {
  Sim3 Z_a_b;   ///< T_world_a^-1 T_world_b
  Mat7 Lambda;  ///< information of e, symmetric positive definite
};

/// Pose valid; information finite, symmetric, positive definite.
bool valid_link(const ChainLink& link);

/// e = log(Z_a_b^-1 T_world_a^-1 T_world_b), 7 rows, in the tangent of b at e = 0; its cost is that
/// of the whitened norm u, u^2 = e' Lambda e.
Vec7 chain_residual(const Sim3& T_world_a, const Sim3& T_world_b, const Sim3& Z_a_b);

}  // namespace unisim
