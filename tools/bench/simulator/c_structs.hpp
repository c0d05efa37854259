// SPDX-License-Identifier: MIT
// What is simulated, in the structs of unisim.h.
#pragma once

#include "tools/bench/simulator/world.hpp"
#include "unisim/unisim.h"

namespace unisim::simulator {

inline unisim_sim3 to_c(const RigidPose& T) {
  const Eigen::Quaterniond q(T.R);
  return {{q.x(), q.y(), q.z(), q.w()}, {T.t.x(), T.t.y(), T.t.z()}, 1.0};
}

/// Borrowed.
inline unisim_depth_map to_c(const DepthMap& depth) {
  return {depth.data(), nullptr, kDepthWidth, kDepthHeight};
}

}  // namespace unisim::simulator
