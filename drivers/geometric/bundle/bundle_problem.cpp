// SPDX-License-Identifier: MIT
// Cameras, points, observations and shared intrinsics of a bundle adjustment, in arrays of fixed
// capacity.
#include "drivers/geometric/bundle/bundle_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unisim::geometric {

CameraModel BundleIntrinsics::model() const {
  CameraModel model;
  model.focal_px = std::exp(log_focal);
  model.k1 = k1;
  model.cx = cx;
  model.cy = cy;
  return model;
}

void BundleIntrinsics::set_model(const CameraModel& model) {
  log_focal = std::log(model.focal_px);
  k1 = model.k1;
  cx = model.cx;
  cy = model.cy;
}

BundleProblem::BundleProblem(const BundleCapacity& capacity) : capacity_(capacity) {
  cameras_.reserve(static_cast<std::size_t>(capacity.cameras));
  points_.reserve(static_cast<std::size_t>(capacity.points));
  observations_.reserve(static_cast<std::size_t>(capacity.observations));
}

void BundleProblem::clear() {
  cameras_.clear();
  points_.clear();
  observations_.clear();
  free_cameras_ = 0;
  intrinsics = BundleIntrinsics();
}

int BundleProblem::add_camera(const CameraPose& pose, bool fixed) {
  if (camera_count() >= capacity_.cameras) return -1;
  if (!fixed && free_cameras_ >= capacity_.free_cameras) return -1;
  if (!fixed) ++free_cameras_;
  cameras_.push_back({pose, fixed});
  return camera_count() - 1;
}

bool BundleProblem::any_fixed() const {
  return std::any_of(cameras_.begin(), cameras_.end(),
                     [](const BundleCamera& camera) { return camera.fixed; });
}

int BundleProblem::add_point(const Eigen::Vector3d& position_world) {
  if (point_count() >= capacity_.points) return -1;
  BundlePoint point;
  point.position = position_world;
  point.first = observation_count();
  points_.push_back(point);
  return point_count() - 1;
}

bool BundleProblem::add_observation(int camera, double u, double v, double weight,
                                    const Eigen::Vector2d& sway) {
  if (points_.empty() || observation_count() >= capacity_.observations) return false;
  if (camera < 0 || camera >= camera_count()) return false;
  BundlePoint& point = points_.back();
  if (point.count > 0 && observations_.back().camera >= camera) return false;
  observations_.push_back({camera, u, v, weight, sway});
  ++point.count;
  return true;
}

void BundleProblem::drop_point() {
  if (points_.empty()) return;
  observations_.resize(static_cast<std::size_t>(points_.back().first));
  points_.pop_back();
}

double BundleProblem::reprojection_error_px(const BundlePoint& point, int i) const {
  const BundleObservation& seen = observation(i);
  const CameraModel model = intrinsics.model();
  Eigen::Vector2d projected;
  if (!model.project_undistorted(camera(seen.camera).pose.apply(point.position), &projected)) {
    return std::numeric_limits<double>::infinity();
  }
  return (projected - model.undistort(seen.still(intrinsics.readout_s))).norm();
}

}  // namespace unisim::geometric
