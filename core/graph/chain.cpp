// SPDX-License-Identifier: MIT
// Chain factor.
#include "core/graph/chain.hpp"

#include "core/base/positive_definite.hpp"
#include "core/graph/relative_pose.hpp"

namespace unisim {

bool valid_link(const ChainLink& link) {
  if (!link.Z_a_b.valid() || !link.Lambda.allFinite()) return false;
  constexpr double kSymmetry = 1e-9;
  const double size = link.Lambda.cwiseAbs().maxCoeff();
  const double skew = (link.Lambda - link.Lambda.transpose()).cwiseAbs().maxCoeff();
  return skew <= kSymmetry * size && is_positive_definite(link.Lambda);
}

Vec7 chain_residual(const Sim3& T_world_a, const Sim3& T_world_b, const Sim3& Z_a_b) {
  return relative_pose_residual(T_world_a, T_world_b, Z_a_b, Sim3());
}

}  // namespace unisim
