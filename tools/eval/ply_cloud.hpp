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

/// Writes x, y, z as binary PLY of floats. @return false when it cannot be written
bool write_ply(const std::string& path, const Cloud& cloud);

/// One point per cube with this side, the mean of those in it. Should these be more than
/// kMostThinned, larger cubes. @param[in,out] side above 0
Cloud thinned(const Cloud& cloud, double* side);

inline constexpr size_t kMostThinned = 4U << 20U;

}  // namespace unisim::eval
