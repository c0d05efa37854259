// SPDX-License-Identifier: MIT
// Pose of one camera from known points: robust Levenberg-Marquardt.
#pragma once

#include <cstdint>

#include "drivers/geometric/bundle/camera_model.hpp"

namespace unisim::geometric {

/// A known point and where it is seen.
struct PoseObservation {
  Eigen::Vector3d point_world;
  Eigen::Vector2d undistorted_px;  ///< CameraModel::undistort() of the pixel
  double weight = 1.0;  ///< multiplies the squared residual (soft landmarks: 0.3); 0: ignored
};

struct PoseOptions {
  int max_iterations = 12;
  double pixel_scale = 1.0;  ///< residual = pixels / pixel_scale; image diagonal / 800
  double cauchy = 1.0;       ///< width of the Cauchy loss, scaled pixels
  double inlier = 6.0;       ///< residuals below are inliers, scaled pixels
  double relative_tolerance = 1e-4;
};

enum class PoseStatus {
  kOk,            ///< pose holds the best state found
  kTooFew,        ///< fewer than 3 usable observations; pose = start
  kInvalidInput,  ///< a number is not finite or an option out of range; pose = start
};

struct PoseResult {
  PoseStatus status = PoseStatus::kInvalidInput;
  CameraPose pose;
  double cost =
      0.0;  ///< robust, scaled pixels squared / 2; a point behind the camera costs a constant
  int inliers = 0;
  int iterations = 0;
  /// J^T W J at the pose, scaled pixels, tangent (translation 3, rotation 3) of retract().
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Refines `start`. Candidates (last pose, constant velocity) are the caller's: solve each, keep
/// the least cost. @param[out] inlier  NULL or `count` flags (1 inlier) Stateless, does not
/// allocate; < 0.2 ms for 300 points.
PoseResult solve_pose(const CameraModel& camera, const CameraPose& start,
                      const PoseObservation* observations, int count, const PoseOptions& options,
                      std::uint8_t* inlier);

}  // namespace unisim::geometric
