// SPDX-License-Identifier: MIT
// Images of a textured room from a moving camera, with exact poses: rendered in the test.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace unisim::geometric::test {

inline constexpr int kWidth = 320;
inline constexpr int kHeight = 240;
inline constexpr double kFocal = 300.0;

/// Camera to world.
struct CameraPlace {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
};

using GrayImage = std::vector<std::uint8_t>;

/// Where a pixel lies in such an image.
inline std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
}

/// View into a box room of 6 x 4 x 6 with a smooth random pattern on its walls.
GrayImage render_room(const CameraPlace& place, double focal = kFocal);

/// A walk sideways and forward while looking around slowly; step 0, 1, 2 ...
CameraPlace walk(int step);
/// A turn on the spot.
CameraPlace turn(int step);

}  // namespace unisim::geometric::test
