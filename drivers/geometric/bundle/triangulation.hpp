// SPDX-License-Identifier: MIT
// One point from several posed views: linear start, Gauss-Newton, gates.
#pragma once

#include "drivers/geometric/bundle/camera_model.hpp"

namespace unisim::geometric {

/// One view of the point.
struct TriangulationView {
  const CameraPose* pose = nullptr;
  Eigen::Vector2d normalized;  ///< CameraModel::normalize() of the pixel
};

struct TriangulationOptions {
  double min_parallax_rad = 0.0175;  ///< largest angle between two rays must reach this
  double max_error = 0.004;          ///< reprojection gate in focal lengths (pixels / focal_px)
  int iterations = 5;                ///< of Gauss-Newton
};

enum class TriangulationStatus {
  kOk,
  kTooFewViews,   ///< fewer than 2
  kLowParallax,   ///< largest angle below the gate; parallax_rad is set, nothing else
  kBehind,        ///< behind one of the cameras, or no finite answer
  kReprojection,  ///< a view is off by more than the gate; position and max_error are set
};

struct TriangulationResult {
  TriangulationStatus status = TriangulationStatus::kTooFewViews;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the world
  double parallax_rad = 0.0;                           ///< largest angle between two rays
  double max_error = 0.0;  ///< largest reprojection error, focal lengths
};

/// Largest angle between the rays of any two views. O(count^2).
double parallax_angle(const TriangulationView* views, int count);

/// Triangulates. Does not allocate. Bad numbers give kLowParallax or kBehind.
TriangulationResult triangulate(const TriangulationView* views, int count,
                                const TriangulationOptions& options);

}  // namespace unisim::geometric
