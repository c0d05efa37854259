// SPDX-License-Identifier: MIT
// Points of a PLY file.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace unisim::eval {

/// Largest coordinate of a point that is used: squares of distances are still floats.
inline constexpr double kFarthest = 1e18;

/// Finite and no coordinate beyond kFarthest.
bool is_near(const Eigen::Vector3d& point);

struct Cloud {
  std::string name;
  std::vector<Eigen::Vector3d> points;
  int64_t skipped = 0;  ///< vertices that are not near
};

/// Reads x, y, z of the vertices of an ascii or binary (either byte order) PLY; other properties
/// and what follows the vertices are passed over. @throws InputError
Cloud read_ply(const std::string& path);

}  // namespace unisim::eval
