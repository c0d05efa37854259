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
  bool roll_open = false;  ///< found from a straight line: one of many turns about it

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return s * (R * p) + t; }
};

/// The similarity that takes `from` nearest to `to`: eq. 34-43. kNone is the identity, kSe3 keeps s
/// = 1.
///
/// Points on a straight line leave the turn about it open; the distances do not depend on it.
/// @throws ScoreError for fewer than three points and for points that do not move
Similarity align(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                 Alignment alignment);

}  // namespace unisim::eval
