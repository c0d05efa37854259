// SPDX-License-Identifier: MIT
// How wrong the simulated predictions are.
#pragma once

namespace unisim::simulator {

/// Angles in degrees, lengths relative to the mean depth, the rest in natural logarithms.
/// Calibrated so that a full graph reaches the errors published for learned predictors.
struct NoiseModel {
  double scale = 1.0;  ///< of all pose noise

  // Unit of length of one inference: depth^-unit_content times a log-normal factor.
  double unit_content = 0.75;
  double unit_pair = 0.05;
  double unit_window = 0.05;

  // Pairs.
  double pair_rotation = 0.18;
  double pair_turn = 0.01;      ///< relative error of the rotation angle
  double pair_baseline = 0.04;  ///< baseline against depth
  double pair_translation = 0.0015;
  double pair_view = 0.04;  ///< depth scale of a view

  // Windows and loops: independent, and as a walk per keyframe away from the origin.
  double window_rotation = 0.10;
  double window_rotation_walk = 0.05;
  double window_translation = 0.0015;
  double window_translation_walk = 0.0005;
  double window_baseline = 0.01;
  double window_drift = 0.01;  ///< scale, slowly growing, eight keyframes away
  double window_view = 0.01;

  // Second half of a loop against the first.
  double loop_rotation = 0.5;
  double loop_translation = 0.006;
  double loop_scale = 0.01;

  // Depth maps.
  double tilt = 0.02;   ///< smooth over the image
  double pixel = 0.03;  ///< relative, each pixel
  double outlier_share = 0.05;
  double outlier = 0.6;
  double holes = 0.0;  ///< share of pixels without depth
};

}  // namespace unisim::simulator
