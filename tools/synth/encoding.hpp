// SPDX-License-Identifier: MIT
// Frames that carry their own truth: depth and pose written into the pixels as numbers.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "tools/synth/camera.hpp"
#include "tools/synth/renderer.hpp"

namespace unisim::synth {

/// Numbers in the first row of an encoded frame, one pixel each; see README.md.
inline constexpr int kHeaderPixels = 15;

/// What an encoded frame says besides its depth.
struct EncodedHeader {
  Eigen::Isometry3d T_world_cam;
  double share;   ///< 0 <= share < 1: from these of its views an inference takes its unit of length
  double spread;  ///< standard deviation of the logarithm of that unit
};

/// 8-bit BGR image whose pixels are whole numbers of 24 bits, red the high byte: row 0 the header,
/// the others the depth.
cv::Mat encode_frame(const DepthImage& depth, const Camera& camera, const EncodedHeader& header);

}  // namespace unisim::synth
