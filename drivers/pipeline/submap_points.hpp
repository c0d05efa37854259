// SPDX-License-Identifier: MIT
// A few points of a window, for people and planners: spread over its views, the least sure left
// out.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/predictor.h"

namespace unisim::pipeline {

/// @param image_width, image_height of the frames, pixels
/// @param most    points to give
/// @param[out] xyz in the camera frame of view number `count / 2`, unit of the window; empty where
///                 the window does not know its focal length
void sample_points(const unisim_window_prediction& window, int32_t image_width,
                   int32_t image_height, int32_t most, std::vector<float>* xyz);

}  // namespace unisim::pipeline
