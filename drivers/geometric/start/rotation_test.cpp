// SPDX-License-Identifier: MIT
// Tells a camera that only turned from one that moved.
#include "drivers/geometric/start/rotation_test.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/common/median.hpp"

namespace unisim::geometric {

namespace {

constexpr int kRounds = 5;
constexpr double kFocalSteps[] = {0.5, 0.63, 0.8, 1.0, 1.26, 1.6};
constexpr double kStepRatio = 1.26;
constexpr int kRefinements = 5;

Eigen::Vector3d ray(const cv::Point2f& p, const cv::Size& size, double focal) {
  return Eigen::Vector3d((p.x - (size.width / 2.0 - 0.5)) / focal,
                         (p.y - (size.height / 2.0 - 0.5)) / focal, 1.0)
      .normalized();
}

/// Robust best rotation (Kabsch with weights from the last residuals) and its median residual.
double residual_at(const std::vector<cv::Point2f>& from, const std::vector<cv::Point2f>& to,
                   const cv::Size& size, double focal) {
  std::vector<double> residual(from.size(), 0.0);
  double scale = std::numeric_limits<double>::infinity();
  double middle = 0;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (size_t i = 0; i < from.size(); ++i) {
      const double w = 1.0 / (1.0 + residual[i] * residual[i] / (scale * scale));
      moment += w * ray(to[i], size, focal) * ray(from[i], size, focal).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
    flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    const Eigen::Matrix3d rotation = svd.matrixU() * flip * svd.matrixV().transpose();
    for (size_t i = 0; i < from.size(); ++i) {
      const double cosine = (rotation * ray(from[i], size, focal)).dot(ray(to[i], size, focal));
      residual[i] = focal * std::acos(std::clamp(cosine, -1.0, 1.0));
    }
    std::vector<double> any_order = residual;
    middle = drivers::median(&any_order);
    scale = std::max(0.3, middle);
  }
  return middle;
}

}  // namespace

double rotation_residual_px(const std::vector<cv::Point2f>& from,
                            const std::vector<cv::Point2f>& to, const cv::Size& size,
                            double focal_px, bool focal_known) {
  if (from.empty()) return 0;
  if (focal_known) return residual_at(from, to, size, focal_px);
  double best = std::numeric_limits<double>::infinity();
  double best_focal = focal_px;
  const auto try_focal = [&](double focal) {
    const double residual = residual_at(from, to, size, focal);
    if (residual >= best) return;
    best = residual;
    best_focal = focal;
  };
  for (const double step : kFocalSteps) try_focal(step * focal_px);
  double ratio = kStepRatio;
  for (int i = 0; i < kRefinements; ++i) {
    ratio = std::sqrt(ratio);
    const double middle = best_focal;
    try_focal(middle * ratio);
    try_focal(middle / ratio);
  }
  return best;
}

}  // namespace unisim::geometric
