// SPDX-License-Identifier: MIT
// How loops are looked for with predictors that have no map of their own.
#pragma once

#include <cstdint>

namespace unisim::pipeline {

struct LoopConfig {
  int32_t places = 256;  ///< keyframes kept to come back to; 0: no loops
  int32_t gap = 30;      ///< keyframes from a place to its next view, at least
  int32_t tries = 2;     ///< places that one keyframe is compared with, at most
  /// Descriptors less alike are not compared: dot product over the square of the newer one's
  /// length. With VLAD 95 % of the loops that the geometric predictor verified lie above
  /// (redkitchen from five first frames, two videos), 90 to 95 % of the places of other recordings
  /// below (KITTI, box, desk, corridor, room). A descriptor model may want more.
  double likeness = 0.12;
};

}  // namespace unisim::pipeline
