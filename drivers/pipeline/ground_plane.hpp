// SPDX-License-Identifier: MIT
// The ground under the cameras of a window, and how high above it they are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/predictor.h"

namespace unisim::pipeline {

struct GroundPlane {
  double height = 0.0;      ///< of the cameras, unit of the window; 0: no ground was found
  double sigma = 0.0;       ///< its relative standard deviation
  const char* reason = "";  ///< why none was found; static text
  int32_t points = 0;       ///< that lie in it
};

/// Looks for the plane that a robot drives on: seen in the lower part of the images, level with
/// what the camera calls down (which way gravity points is not known), nothing below it, and
/// everywhere as far from the camera, whose height does not change.
///
/// RANSAC with a fixed sequence of samples: the same window gives the same plane.
class GroundFinder {
 public:
  /// @param window with depth and focal length
  /// @param image_width, image_height of the frames, pixels
  GroundPlane find(const unisim_window_prediction& window, int32_t image_width,
                   int32_t image_height);

 private:
  /// In a frame whose third axis points down.
  using Place = std::array<double, 3>;
  /// down = a x + b y + c
  struct Plane {
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
    double below(const Place& p) const { return p[2] - a * p[0] - b * p[1] - c; }
  };
  void take_samples(const unisim_window_prediction& window, double width, double height);
  bool turn_down(const unisim_window_prediction& window);
  bool through(const Place& p, const Place& q, const Place& r, Plane* plane) const;
  double height_over(const Plane& plane, double* spread);
  double cost_of(const Plane& plane, double tolerance) const;
  bool fit(double tolerance, Plane* plane) const;
  GroundPlane judge(const Plane& plane, double height, double spread) const;

  std::vector<Place> samples_;  // of the window, then with down
  std::vector<Place> cameras_;
  std::vector<double> heights_;
};

}  // namespace unisim::pipeline
