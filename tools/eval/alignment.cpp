// SPDX-License-Identifier: MIT
// Least-squares alignment of point sets (Umeyama, PAMI 1991).
#include "tools/eval/alignment.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <limits>
#include <numeric>

#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

const char* alignment_name(Alignment alignment) {
  return alignment == Alignment::kSim3 ? "sim3" : alignment == Alignment::kSe3 ? "se3" : "none";
}

Similarity align(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                 Alignment alignment) {
  Similarity T;
  if (alignment == Alignment::kNone) return T;
  const double n = static_cast<double>(from.size());
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d mean_from = std::accumulate(from.begin(), from.end(), zero) / n;
  const Eigen::Vector3d mean_to = std::accumulate(to.begin(), to.end(), zero) / n;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance = 0;
  for (size_t k = 0; k < from.size(); ++k) {
    covariance += (to[k] - mean_to) * (from[k] - mean_from).transpose() / n;
    variance += (from[k] - mean_from).squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()(1) > std::numeric_limits<double>::epsilon())) {
    throw InputError(
        std::to_string(from.size()) +
        " associated positions lie on a line or in a point: alignment is not possible, use "
        "--align none or a longer trajectory");
  }
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign(2) = -1;
  T.R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  if (alignment == Alignment::kSim3) T.s = svd.singularValues().dot(sign) / variance;
  T.t = mean_to - T.s * (T.R * mean_from);
  return T;
}

}  // namespace unisim::eval
