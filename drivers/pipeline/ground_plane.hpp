// SPDX-License-Identifier: MIT
// The ground under the cameras of a window, and how high above it they are.
#pragma once

#include <cstdint>

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
/// @param window with depth and focal length
/// @param image_width, image_height of the frames, pixels
GroundPlane find_ground(const unisim_window_prediction& window, int32_t image_width,
                        int32_t image_height);

}  // namespace unisim::pipeline
