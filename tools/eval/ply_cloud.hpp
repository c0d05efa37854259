// SPDX-License-Identifier: MIT
// Points of a PLY file.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace unisim::eval {

struct Cloud {
  std::string name;
  std::vector<Eigen::Vector3d> points;
  int64_t skipped = 0;  ///< vertices that are not finite
};

/// Reads x, y, z of the vertices of an ascii or binary (either byte order) PLY; other properties
/// and what follows the vertices are passed over. @throws InputError
Cloud read_ply(const std::string& path);

}  // namespace unisim::eval
