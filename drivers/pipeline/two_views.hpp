// SPDX-License-Identifier: MIT
// Whether a two-view prediction of two distant keyframes shows one place.
#pragma once

#include <cstdint>

#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// Two views of one prediction, a unit for both.
struct TwoViews {
  unisim_sim3 T_a_b;
  unisim_depth_map depth_a;
  unisim_depth_map depth_b;
  double focal;   ///< in image widths
  double aspect;  ///< image width over height
};

/// Depth of one view seen from the other, on a grid of cells, both ways.
struct Overlap {
  int32_t cells = 0;    ///< with depth
  int32_t in_view = 0;  ///< of these: in the other view's image
  int32_t agree = 0;    ///< of these: at the depth that the other view has there
  double shift = 0.0;   ///< distance of the cameras over the smaller median depth
};

/// Views of two keyframes out of a prediction. aspect stays as it is.
/// @param image_width pixels, of focal_px; 0: focal is not wanted
/// @return false: the prediction lacks one of them, or has no finite pose or depth there
bool pick_two(const unisim_window_prediction& window, int32_t a, int32_t b, int32_t image_width,
              TwoViews* out);

Overlap measure_overlap(const TwoViews& views);

/// T_a_b with lengths in median depths of a.
unisim_sim3 in_median_depths(const TwoViews& views);

/// Two predictions of one pair of keyframes, in_median_depths(), say the same.
bool agree(const unisim_sim3& one, const unisim_sim3& other);

/// NULL where the two show one place, else why not; static text.
const char* why_apart(const Overlap& overlap);

}  // namespace unisim::pipeline
