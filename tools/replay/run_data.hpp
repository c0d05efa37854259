// SPDX-License-Identifier: MIT
// What a finished run is known by: copied out of session and record once, then only read.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/source.h"
#include "tools/replay/run_record.hpp"
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
  std::vector<unisim_stamped_pose> map;  ///< keyframes of earlier runs that this one began with,
                                         ///< then those of `trajectory`
  std::vector<double> submap_scale;      ///< by submap id: its unit to the world, 0 not known
  unisim_session_info session{};  ///< counts are those of this run, `segments` of the whole map
};

/// Reads everything out of the session and of the record of its run.
/// @param before what the session had from earlier runs, which counts for none of this one
RunData collect(unisim_session* session, const RunRecord& record, bool every_frame,
                const unisim_session_info& before);

}  // namespace unisim::replay
