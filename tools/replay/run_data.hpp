// SPDX-License-Identifier: MIT
// What a finished run is known by: copied out of session and pipeline once, then only read.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/pipeline/pipeline.hpp"
#include "drivers/source.h"
#include "unisim/unisim.h"

namespace unisim::replay {

struct KeyframeRow {
  unisim_pose pose;
  int64_t frame_index;
  double covariance_trace;  ///< of the 7x7 covariance, < 0: not known
};

struct RunData {
  std::vector<KeyframeRow> keyframes;           ///< those with a pose, held ones too
  std::vector<unisim_stamped_pose> trajectory;  ///< keyframes whose pose a prediction supports
  std::vector<unisim_stamped_pose> live;        ///< as first given out
  std::vector<unisim_stamped_pose> frames;      ///< all frames, with every_frame
  unisim_session_info session{};
};

/// Reads everything out of the session.
RunData collect(unisim_session* session, const pipeline::Result& result, bool every_frame);

}  // namespace unisim::replay
