// SPDX-License-Identifier: MIT
// The true cloud of a recording: its depth images at its true poses.
#pragma once

#include <limits>

#include "tools/eval/depth_images.hpp"
#include "tools/eval/ply_cloud.hpp"

namespace unisim::eval {

struct TruthOptions {
  double first_s = -std::numeric_limits<double>::infinity();  ///< images from this time
  double last_s = std::numeric_limits<double>::infinity();    ///< to this one
  int64_t every = 1;       ///< of the images, the first and each n-th after it
  int pixel_step = 2;      ///< of rows and columns, each n-th
  double max_depth = 0.0;  ///< metres; farther pixels are left out; 0: none are
  double voxel = 0.0;      ///< side of the cubes that hold one point each, above 0
};

struct TruthCloud {
  Cloud cloud;          ///< world of the poses, metres
  double voxel = 0.0;   ///< as asked, or larger: at most kMostThinned points
  int64_t images = 0;   ///< used
  int64_t unposed = 0;  ///< left out, no pose near their time
  int64_t unreadable = 0;
};

/// Reads one image after the other. @throws InputError when no point comes of it
TruthCloud make_truth(const DepthImages& found, const TruthOptions& options);

}  // namespace unisim::eval
