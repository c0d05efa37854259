// SPDX-License-Identifier: MIT
// Hand-held camera paths.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/bench/simulator/noise_source.hpp"
#include "tools/bench/simulator/rigid_pose.hpp"

namespace unisim::simulator {

enum class WorldKind {
  kScan,  ///< faces one part of a room and comes back to it, 0.03 to 0.05 m per keyframe
  kRoom,  ///< turns through 360 degrees, several rounds
  kWalk   ///< 28 m rounds through a 12 x 8 m flat
};

/// Camera-to-world poses, one keyframe every 1/6 s. World z is up; cameras have OpenCV axes.
std::vector<RigidPose> camera_path(WorldKind kind, int32_t keyframes, NoiseSource* noise);

}  // namespace unisim::simulator
