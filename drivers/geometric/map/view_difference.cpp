// SPDX-License-Identifier: MIT
// How differently two cameras see a point.
#include "drivers/geometric/map/view_difference.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::geometric {

namespace {
constexpr double kMaxLogScale = 0.35;  // between the two depths
constexpr double kMaxViewAngle = 0.6;  // rad
constexpr double kViewAngleUnit = 0.5;
constexpr double kMaxRoll = 0.35;  // rad
}  // namespace

double roll_between(const CameraPose& a, const CameraPose& b) {
  const Eigen::Matrix3d turn = b.R * a.R.transpose();
  return std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
}

double view_difference(const CameraPose& a, const CameraPose& b, const Eigen::Vector3d& point) {
  const double depth_a = a.apply(point).z();
  const double depth_b = b.apply(point).z();
  if (!(depth_a > kMinDepth) || !(depth_b > kMinDepth)) return kNoView;
  const double scale = std::abs(std::log(depth_a / depth_b));
  const double cosine = (point - a.center()).normalized().dot((point - b.center()).normalized());
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double roll = std::abs(roll_between(a, b));
  if (!(scale < kMaxLogScale && angle < kMaxViewAngle && roll < kMaxRoll)) return kNoView;
  return scale / kMaxLogScale + angle / kViewAngleUnit + roll / kMaxRoll;
}

}  // namespace unisim::geometric
