// SPDX-License-Identifier: MIT
// From the light that falls on the sensor to the bytes it gives: exposure, noise, rounding.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "tools/synth/camera.hpp"
#include "tools/synth/renderer.hpp"

namespace unisim::synth {

struct SensorOptions {
  bool noise = false;           ///< read noise of 1.5 grey levels and shot noise up to 3
  bool exposure_jumps = false;  ///< the gain changes by up to a third every half to two seconds
  double fps = 30;
  uint64_t seed = 1;
};

/// Exposure gain of a frame; 1 without jumps.
double exposure_gain(const SensorOptions& options, int frame);

/// 8-bit BGR of a rendered image. @param scale  1 / number of views summed in `colors`
cv::Mat expose(const ColorImage& colors, const Camera& camera, float scale,
               const SensorOptions& options, int frame);

/// Depth as 16-bit numbers of `factor` per metre; 0 where there is none or it does not fit.
cv::Mat encode_depth(const DepthImage& depth, const Camera& camera, float factor);

}  // namespace unisim::synth
