// SPDX-License-Identifier: MIT
// Cameras, points, observations and shared intrinsics of a bundle adjustment, in arrays of fixed
// capacity.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/bundle/camera_model.hpp"

namespace unisim::geometric {

/// What a BundleProblem, and what works on it, can hold. Memory is taken once, from these numbers.
struct BundleCapacity {
  int cameras = 0;  ///< fixed ones included
  int free_cameras =
      0;  ///< at most this many are not fixed; the reduced system grows with its square
  int points = 0;
  int observations = 0;
};

/// One camera.
struct BundleCamera {
  CameraPose pose;
  bool fixed = false;
};

/// One point; its observations are observations()[first, first + count).
struct BundlePoint {
  Eigen::Vector3d position;  ///< in the world
  std::int32_t first = 0;
  std::int32_t count = 0;
};

/// One point seen by one camera.
struct BundleObservation {
  std::int32_t camera = 0;
  double u = 0.0;  ///< distorted pixel
  double v = 0.0;
  double weight =
      1.0;  ///< inverse standard deviation relative to the others (1: ordinary, 0: left out)
  /// Pixels it moves for each second of readout.
  Eigen::Vector2d sway = Eigen::Vector2d::Zero();
  /// What the model explains.
  Eigen::Vector2d still(double readout_s) const { return Eigen::Vector2d(u, v) - readout_s * sway; }
};

/// Shared intrinsics with independent Gaussian priors; a sigma <= 0 means no prior.
struct BundleIntrinsics {
  double log_focal = 0.0;
  double k1 = 0.0;
  double cx = 0.0;  ///< principal point, pixels
  double cy = 0.0;
  bool free_focal = false;
  bool free_k1 = false;
  bool free_center = false;  ///< the principal point
  double log_focal_mean = 0.0;
  double log_focal_sigma = 0.0;
  double k1_mean = 0.0;
  double k1_sigma = 0.0;
  double cx_mean = 0.0;
  double cy_mean = 0.0;
  double center_sigma_px = 0.0;  ///< of each of cx and cy
  double readout_s = 0.0;        ///< from the first row of an image to the last
  bool free_readout = false;
  double readout_mean_s = 0.0;
  double readout_sigma_s = 0.0;

  CameraModel model() const;                 ///< camera with these values
  void set_model(const CameraModel& model);  ///< takes focal, k1 and centre; flags and priors stay
};

/// A bundle adjustment problem. Build it as: intrinsics, cameras in time order, then for each point
/// add_point() followed by its observations. Nothing allocates after construction.
class BundleProblem {
 public:
  explicit BundleProblem(const BundleCapacity& capacity);

  /// Forgets cameras, points and observations; intrinsics become default.
  void clear();

  /// @return index of the camera, -1 when `cameras` or `free_cameras` is reached
  int add_camera(const CameraPose& pose, bool fixed);

  /// Starts a new point. @return its index, -1 when `points` is reached
  int add_point(const Eigen::Vector3d& position_world);

  /// Adds an observation to the newest point. Cameras of a point must come in strictly ascending
  /// order.
  /// @return false, nothing added: no point yet, unknown camera, order broken, `observations`
  /// reached
  bool add_observation(int camera, double u, double v, double weight,
                       const Eigen::Vector2d& sway = Eigen::Vector2d::Zero());

  /// Takes the newest point back with its observations (say, because too few were found).
  void drop_point();

  const BundleCapacity& capacity() const { return capacity_; }
  int camera_count() const { return static_cast<int>(cameras_.size()); }
  int free_camera_count() const { return free_cameras_; }
  bool any_fixed() const;
  int point_count() const { return static_cast<int>(points_.size()); }
  int observation_count() const { return static_cast<int>(observations_.size()); }

  BundleCamera& camera(int i) { return cameras_[static_cast<std::size_t>(i)]; }
  const BundleCamera& camera(int i) const { return cameras_[static_cast<std::size_t>(i)]; }
  BundlePoint& point(int i) { return points_[static_cast<std::size_t>(i)]; }
  const BundlePoint& point(int i) const { return points_[static_cast<std::size_t>(i)]; }
  /// Set weight 0 to leave an observation out of the next solve.
  BundleObservation& observation(int i) { return observations_[static_cast<std::size_t>(i)]; }
  const BundleObservation& observation(int i) const {
    return observations_[static_cast<std::size_t>(i)];
  }

  /// Distance in undistorted pixels between observation `i` of `point` and its projection; infinite
  /// when the point is behind the camera. What gates compare (not divided by any pixel scale).
  double reprojection_error_px(const BundlePoint& point, int i) const;

  BundleIntrinsics intrinsics;

 private:
  BundleCapacity capacity_;
  int free_cameras_ = 0;
  std::vector<BundleCamera> cameras_;
  std::vector<BundlePoint> points_;
  std::vector<BundleObservation> observations_;
};

}  // namespace unisim::geometric
