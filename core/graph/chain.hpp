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

/// u^2 as a quadratic form of right perturbations of a and b.
struct ChainNormal {
  double u_squared;
  Mat7 H_aa;
  Mat7 H_ba;
  Mat7 H_bb;
  Vec7 g_a;
  Vec7 g_b;
};
void chain_normal(const Sim3& T_world_a, const Sim3& T_world_b, const ChainLink& link,
                  ChainNormal* out);

}  // namespace unisim
