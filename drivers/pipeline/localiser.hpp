// SPDX-License-Identifier: MIT
// Poses of single frames in the world of a session's map, which stays as it is.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// Predictor and session know the same keyframes, each in its own frame and unit: a frame that the
/// predictor has found lies to its nearest keyframe there as it does here.
class Localiser {
 public:
  /// @param session, predictor with a map, which must not change; borrowed
  Localiser(const unisim_session* session, unisim_predictor* predictor);

  /// @param[out] segment of the session
  /// @return false: the session has no pose near there
  bool pose(const unisim_location& found, unisim_sim3* T_world_cam, int32_t* segment) const;

 private:
  /// A keyframe that both know.
  struct Common {
    int32_t id;
    int32_t segment;         // of the session
    int32_t map_segment;     // of the predictor
    unisim_sim3 T_world_kf;  // scale 1
    unisim_sim3 T_map_kf;
    double scale;  // of the map's unit to the world's, as it is there
  };
  double scale_at(const Common& keyframe) const;

  std::vector<Common> keyframes_;  // by id
};

}  // namespace unisim::pipeline
