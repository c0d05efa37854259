// SPDX-License-Identifier: MIT
// Least-squares alignment of point sets (Umeyama, PAMI 1991).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace unisim::eval {

enum class Alignment { kNone, kSe3, kSim3 };

const char* alignment_name(Alignment alignment);

/// p' = s R p + t.
struct Similarity {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double s = 1.0;

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return s * (R * p) + t; }
};

/// The similarity that takes `from` nearest to `to`: eq. 34-43. kNone is the identity, kSe3 keeps s
/// = 1.
/// @throws InputError when the points lie on a line, so that a rotation is left open
Similarity align(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                 Alignment alignment);

}  // namespace unisim::eval
