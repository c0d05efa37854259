// SPDX-License-Identifier: MIT
// Simulated world: a room with boxes, a camera path through it, exact depth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/bench/simulator/camera_path.hpp"

namespace unisim::simulator {

inline constexpr int32_t kDepthWidth = 20;
inline constexpr int32_t kDepthHeight = 15;
inline constexpr int32_t kDepthPixels = kDepthWidth * kDepthHeight;

using DepthMap = std::array<float, kDepthPixels>;  ///< z-depth [m], row-major

/// Image position of a pixel, both coordinates in [-1, 1].
Eigen::Vector2d image_position(int32_t pixel);

struct World {
  std::vector<RigidPose> T_world_kf;
  std::vector<DepthMap> depth;     ///< of each keyframe
  std::vector<double> mean_depth;  ///< of each keyframe
  int32_t keyframes() const { return static_cast<int32_t>(T_world_kf.size()); }
};

/// The same world for the same arguments.
World make_world(WorldKind kind, int32_t keyframes, uint64_t seed);

}  // namespace unisim::simulator
