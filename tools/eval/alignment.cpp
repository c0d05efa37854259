// SPDX-License-Identifier: MIT
// Least-squares alignment of point sets (Umeyama, PAMI 1991).
#include "tools/eval/alignment.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <numeric>

#include "tools/eval/score_error.hpp"

namespace unisim::eval {
namespace {

constexpr size_t kFewest = 3;        // any two points are brought together without error
constexpr double kStraight = 1e-12;  // of variance: a millionth of the length, below any survey
constexpr double kStill = 1e-12;     // of the distance from the origin: rounding of coordinates

void check_motion(double variance, const Eigen::Vector3d& mean, const char* which) {
  if (std::sqrt(variance) > kStill * mean.norm()) return;
  throw ScoreError(ScoreError::Kind::kStill, std::string("the associated positions of the ") +
                                                 which + " do not move: they give no scale");
}

}  // namespace

const char* alignment_name(Alignment alignment) {
  return alignment == Alignment::kSim3 ? "sim3" : alignment == Alignment::kSe3 ? "se3" : "none";
}

Similarity align(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                 Alignment alignment) {
  Similarity T;
  if (alignment == Alignment::kNone) return T;
  if (from.size() < kFewest) {
    throw ScoreError(ScoreError::Kind::kFewPairs,
                     std::to_string(from.size()) + " associated positions are too few to align, " +
                         std::to_string(kFewest) + " are needed");
  }
  const double n = static_cast<double>(from.size());
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d mean_from = std::accumulate(from.begin(), from.end(), zero) / n;
  const Eigen::Vector3d mean_to = std::accumulate(to.begin(), to.end(), zero) / n;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance = 0, variance_to = 0;
  for (size_t k = 0; k < from.size(); ++k) {
    covariance += (to[k] - mean_to) * (from[k] - mean_from).transpose() / n;
    variance += (from[k] - mean_from).squaredNorm() / n;
    variance_to += (to[k] - mean_to).squaredNorm() / n;
  }
  check_motion(variance, mean_from, "estimate");
  check_motion(variance_to, mean_to, "ground truth");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  T.roll_open = svd.singularValues()(1) <= kStraight * svd.singularValues()(0);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign(2) = -1;
  const double rounding = std::numeric_limits<double>::epsilon() * svd.singularValues()(0);
  if (svd.singularValues()(1) <= rounding) {
    T.R = Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0));
  } else {
    T.R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  }
  if (alignment == Alignment::kSim3) T.s = svd.singularValues().dot(sign) / variance;
  T.t = mean_to - T.s * (T.R * mean_from);
  return T;
}

}  // namespace unisim::eval
