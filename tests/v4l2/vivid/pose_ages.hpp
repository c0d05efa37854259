// SPDX-License-Identifier: MIT
// How long it takes from the kernel's stamp of a frame to a pose that is given out.
#pragma once

#include <string>

#include "drivers/source.h"

/// What came of it.
struct PoseAges {
  int poses = 0;
  double p50_ms = 0.0;
  double p95_ms = 0.0;
  bool in_order = true;  ///< one pose after the other, none from before its frame
  std::string text() const;
};

/// Plays `poses` poses of a live run: the camera, the pipeline's threads and queue, a session, and
/// a predictor that knows the answers, so that what is measured is the way and not the tracking.
PoseAges pose_ages(unisim_source* camera, int poses);
