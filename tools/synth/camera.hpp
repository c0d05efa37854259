// SPDX-License-Identifier: MIT
// The camera: pinhole with one radial term. Pixel centres are at whole numbers.
#pragma once

#include <Eigen/Core>

namespace unisim::synth {

struct Camera {
  int width = 640;
  int height = 480;
  double focal_px = 525;
  double radial_k1 = 0;  ///< undistorted = distorted (1 + k1 r^2), r in focal lengths

  double center_x() const { return (width - 1) / 2.0; }
  double center_y() const { return (height - 1) / 2.0; }

  /// Direction (x, y, 1) of pixel position (u, v), camera axes x right, y down, z forward.
  Eigen::Vector2f ray(double u, double v) const {
    const double x = (u - center_x()) / focal_px;
    const double y = (v - center_y()) / focal_px;
    const double scale = 1 + radial_k1 * (x * x + y * y);
    return {static_cast<float>(x * scale), static_cast<float>(y * scale)};
  }
};

}  // namespace unisim::synth
