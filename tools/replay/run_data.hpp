// SPDX-License-Identifier: MIT
// What a finished run is known by: copied out of session and record once, then only read.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/source.h"
#include "tools/replay/pose_sigmas.hpp"
#include "tools/replay/run_record.hpp"
#include "unisim/unisim.h"

namespace unisim::replay {

struct KeyframeRow {
  unisim_pose pose;
  int64_t frame_index;
  double covariance_trace;  ///< of the 7x7 covariance, < 0: not known
  int32_t reason = 0;       ///< UNISIM_REASON_* when it was taken
  PoseSigma sigma = {};     ///< beside the other keyframes of its segment
};

/// Scale of a segment.
struct SegmentScale {
  int32_t segment = -1;
  double metres_per_unit = 0.0;  ///< of the map
  double sigma = 0.0;            ///< relative
};

struct RunData {
  std::vector<KeyframeRow> keyframes;           ///< those with a pose, held ones too
  std::vector<unisim_stamped_pose> trajectory;  ///< keyframes whose pose a prediction supports
  std::vector<unisim_stamped_pose> live;        ///< as first given out
  std::vector<unisim_stamped_pose> frames;      ///< all frames, with every_frame
  std::vector<unisim_stamped_pose> map;  ///< keyframes of earlier runs that this one began with,
                                         ///< then those of `trajectory`
  std::vector<double> submap_scale;      ///< by submap id: its unit to the world, 0 not known
  unisim_session_info session{};     ///< counts are those of this run, `segments` of the whole map
  std::vector<SegmentScale> scales;  ///< segments whose scale is known
  unisim_scale distances{};          ///< counters, where a scale is known
  bool metric = false;               ///< all of it is in metres; else all is in the map's unit

  /// Of the segment with most keyframes; NULL: the run is not metric.
  const SegmentScale* main_scale() const;
};

/// Reads everything out of the session and of the record of its run. Where the scale of all
/// segments is known, lengths are metres.
/// @param before what the session had from earlier runs, which counts for none of this one
RunData collect(unisim_session* session, const RunRecord& record, bool every_frame,
                const unisim_session_info& before);

}  // namespace unisim::replay
