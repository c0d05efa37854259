// SPDX-License-Identifier: MIT
// One point from several posed views: linear start, Gauss-Newton, gates.
#include "drivers/geometric/bundle/triangulation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace unisim::geometric {
namespace {

Eigen::Vector3d world_ray(const TriangulationView& view) {
  return (view.pose->R.transpose() * Eigen::Vector3d(view.normalized.x(), view.normalized.y(), 1.0))
      .normalized();
}

// Point nearest to all rays in the least-squares sense.
bool nearest_to_rays(const TriangulationView* views, int count, Eigen::Vector3d* point) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d ray = world_ray(views[i]);
    const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    A += P;
    b += P * views[i].pose->center();
  }
  const Eigen::LDLT<Eigen::Matrix3d> factor(A);
  *point = factor.solve(b);
  return factor.isPositive() && point->allFinite();
}

struct Reprojection {
  bool in_front = true;
  double squared = 0.0;  // sum
  double largest = 0.0;
};

Reprojection reproject(const TriangulationView* views, int count, const Eigen::Vector3d& point) {
  Reprojection out;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d y = views[i].pose->apply(point);
    out.in_front = out.in_front && y.z() > kMinDepth;
    const double e2 = (y.head<2>() / y.z() - views[i].normalized).squaredNorm();
    out.squared += e2;
    out.largest = std::max(out.largest, std::sqrt(e2));
  }
  return out;
}

Eigen::Vector3d gauss_newton_step(const TriangulationView* views, int count,
                                  const Eigen::Vector3d& point) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d& R = views[i].pose->R;
    const Eigen::Vector3d y = views[i].pose->apply(point);
    const Eigen::Vector2d m = y.head<2>() / y.z();
    Eigen::Matrix<double, 2, 3> J;
    J.row(0) = (R.row(0) - m.x() * R.row(2)) / y.z();
    J.row(1) = (R.row(1) - m.y() * R.row(2)) / y.z();
    H.noalias() += J.transpose() * J;
    g.noalias() += J.transpose() * (m - views[i].normalized);
  }
  return -H.ldlt().solve(g);
}

}  // namespace

double parallax_angle(const TriangulationView* views, int count) {
  double largest = 0.0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d ray = world_ray(views[i]);
    for (int j = 0; j < i; ++j) {
      const Eigen::Vector3d other = world_ray(views[j]);
      largest = std::max(largest, std::atan2(ray.cross(other).norm(), ray.dot(other)));
    }
  }
  return largest;
}

TriangulationResult triangulate(const TriangulationView* views, int count,
                                const TriangulationOptions& options) {
  TriangulationResult result;
  if (count < 2) return result;
  result.parallax_rad = parallax_angle(views, count);
  result.status = TriangulationStatus::kLowParallax;
  if (result.parallax_rad < options.min_parallax_rad) return result;

  result.status = TriangulationStatus::kBehind;
  Eigen::Vector3d point;
  if (!nearest_to_rays(views, count, &point)) return result;
  Reprojection error = reproject(views, count, point);
  for (int i = 0; i < options.iterations && error.in_front; ++i) {
    const Eigen::Vector3d moved = point + gauss_newton_step(views, count, point);
    const Reprojection moved_error = reproject(views, count, moved);
    if (!moved_error.in_front || !(moved_error.squared < error.squared)) break;
    point = moved;
    error = moved_error;
  }
  if (!error.in_front || !point.allFinite()) return result;
  result.position = point;
  result.max_error = error.largest;
  result.status = error.largest < options.max_error ? TriangulationStatus::kOk
                                                    : TriangulationStatus::kReprojection;
  return result;
}

}  // namespace unisim::geometric
