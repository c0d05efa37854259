// SPDX-License-Identifier: MIT
// What the pipeline tells while it runs: keyframes, windows, progress, messages.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/predictor.h"
#include "drivers/source.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// How long the unit of a segment is, as it was known then.
struct Metre {
  double per_unit = 0.0;  ///< metres in a unit; 0: not known, lengths are relative
  double sigma = 0.0;     ///< its relative standard deviation
};

/// Where a run stands.
struct Progress {
  int64_t frames = 0;          ///< taken from the source and tracked
  int64_t frames_total = -1;   ///< -1: not known
  int64_t frames_bad = 0;      ///< unreadable
  int64_t frames_dropped = 0;  ///< late in a realtime run, given up for newer ones in a live one
  int32_t frames_waiting = 0;  ///< read ahead
  int32_t keyframes = 0;       ///< of this run
  int64_t frames_located = 0;  ///< found in the map, with Options::localise
  int32_t submaps = 0;
  int32_t loops = 0;
  int32_t state = 0;      ///< UNISIM_STATE_*
  int32_t reason = 0;     ///< UNISIM_REASON_*, see TrackingReason; 0: all is well
  int64_t newest_ns = 0;  ///< time stamp of the newest frame
  Metre metre;            ///< of the newest keyframe's segment
};

/// A pose as it was first given out, before any later correction.
struct LivePose {
  int64_t timestamp_ns;
  unisim_sim3 T_world_cam;
  int32_t keyframe_id;   ///< -1: a frame between keyframes
  int32_t segment = -1;  ///< -1: not known
  Metre metre = {};      ///< of its segment
  bool late = false;     ///< in a live or realtime run: known only after newer frames had come, as
                         ///< those before the start are; nothing to act by
};

/// What came of a frame that was looked for in the map.
struct LocatedFrame {
  int64_t frame_index;
  int64_t timestamp_ns;
  int32_t state;            ///< UNISIM_STATE_TRACKING: where the frame before let expect it,
                            ///< UNISIM_STATE_RELOCALISED: anew, UNISIM_STATE_LOST: not found, and
                            ///< nothing of what follows is set
  unisim_sim3 T_world_cam;  ///< in the world of the map
  double confidence;        ///< share of the landmarks in view that look as they should, 0..1
  int32_t keyframe_id;      ///< it was compared with
  int32_t inliers;          ///< landmarks that look as they should
  Metre metre = {};         ///< of its segment
};

/// A frame between keyframes, held by the keyframe before it.
struct BetweenPose {
  int64_t timestamp_ns;
  int32_t keyframe_id;
  unisim_sim3 T_kf_frame;
};

/// Receives events on the thread that called Pipeline::run(). Pointers are valid during the call.
/// A listener may read the session through the C API but must not change it.
class Listener {
 public:
  virtual ~Listener() = default;

  /// `frame` became keyframe `id`. frame.image.data is NULL when images are not decoded.
  virtual void on_keyframe(int32_t /*id*/, const unisim_frame& /*frame*/) {}

  /// A pose is known for the first time; in order of time. One of a keyframe may be that of its
  /// frame, given out before the map has taken the keyframe.
  virtual void on_live_pose(const LivePose& /*pose*/) {}

  /// A keyframe has its first pose in the map; after on_live_pose() of its frame.
  virtual void on_keyframe_pose(const unisim_pose& /*keyframe*/) {}

  /// A frame has been tracked, whatever came of it; what takes time belongs here, after its pose.
  virtual void on_frame(const unisim_frame& /*frame*/) {}

  /// A frame between keyframes is placed; with Options::every_frame.
  virtual void on_between_pose(const BetweenPose& /*pose*/) {}

  /// A frame was looked for in the map; with Options::localise. One that is found is a live pose
  /// too.
  virtual void on_located(const LocatedFrame& /*frame*/) {}

  /// A window entered the graph as `submap_id` (never -1: refused windows are not told).
  virtual void on_window(int32_t /*submap_id*/, const unisim_window_prediction& /*window*/) {}

  /// The measurement of `submap_id` was replaced.
  virtual void on_revision(int32_t /*submap_id*/, const unisim_window_revision& /*revision*/) {}

  /// The graph was optimised; windows, revisions and loops told before are in it.
  virtual void on_optimized(const unisim_report& /*report*/) {}

  /// An older keyframe was looked at long ago, and the verdict stands: in order, each once. Those
  /// not told yet are in Result::predictor at the end of a run.
  virtual void on_place(const unisim_place_report& /*look*/) {}

  /// A keyframe or submap has left the sliding window; see unisim_next_retired().
  /// @param pose of the keyframe as it stands now; NULL for a submap
  virtual void on_retired(const unisim_retired& /*retired*/, const unisim_pose* /*pose*/) {}

  /// After each frame.
  virtual void on_progress(const Progress& /*progress*/) {}

  /// One line worth telling: unreadable frames, rejected predictions.
  virtual void on_message(const std::string& /*line*/) {}
};

}  // namespace unisim::pipeline
