// SPDX-License-Identifier: MIT
// Depth images of a recorded sequence: where they lie, their camera, their poses.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

/// Pinhole camera of depth images; pixel centres at whole numbers.
struct DepthCamera {
  double fx = 0.0;  ///< pixels; 0: not known
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  double k1 = 0.0;  ///< undistorted = distorted (1 + k1 r^2), r in focal lengths
};

struct DepthRequest {
  std::string path;              ///< folder of the sequence
  std::string format = "auto";   ///< tum, 7scenes, replica
  std::string ground_truth;      ///< poses; "": those of the sequence
  DepthCamera camera;            ///< fx 0: looked for beside the sequence
  double units_per_metre = 0.0;  ///< of the images; 0: the format's
};

struct DepthImage {
  std::string path;
  double time_s;
};

struct DepthImages {
  std::string format;
  std::string camera_from;  ///< where the camera was read, for protocols
  DepthCamera camera;
  double units_per_metre = 1.0;
  std::vector<DepthImage> images;  ///< by growing time
  Trajectory truth;                ///< camera-to-world, metres
  std::vector<std::string> notes;  ///< what bears on the figures, one line each
};

/// Lists them; no image is read. @throws InputError naming what is missing
DepthImages find_depth_images(const DepthRequest& request);

}  // namespace unisim::eval
