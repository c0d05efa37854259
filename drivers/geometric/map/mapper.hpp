// SPDX-License-Identifier: MIT
// The running map: what is done with each frame and each keyframe, and in which order.
#pragma once

#include <string>
#include <utility>

#include "drivers/geometric/front_end.hpp"
#include "drivers/geometric/image/patch_store.hpp"
#include "drivers/geometric/map/background_adjustment.hpp"
#include "drivers/geometric/map/keyframe_pose.hpp"
#include "drivers/geometric/map/landmark_growth.hpp"
#include "drivers/geometric/map/map_adjustment.hpp"
#include "drivers/geometric/map/remeasure.hpp"
#include "drivers/geometric/map/revive.hpp"
#include "drivers/geometric/map/spot_turns.hpp"
#include "drivers/geometric/map/state.hpp"
#include "drivers/geometric/places/locator.hpp"
#include "drivers/geometric/places/lost_tracks.hpp"
#include "drivers/geometric/places/places.hpp"
#include "drivers/geometric/start/bootstrap.hpp"
#include "drivers/geometric/zoom/zoom_watch.hpp"

namespace unisim::geometric {

/// Counts of a whole run.
struct MapperCounts {
  int32_t restarts = 0;
  int32_t rotation_only = 0;
  int32_t started = 0;  ///< segments that found a start
};

class Mapper {
 public:
  Mapper(const unisim_geometric_config& config, const cv::Size& size);

  void see(const unisim_frame& frame);
  int32_t frame_reason() const { return front_end_.reason(); }  ///< see FrontEnd
  TrackMotion motion() { return front_end_.motion(state_.tracks); }
  /// The last keyframe had lost most of what the one before saw, and the frame seen last shows
  /// something: it had better be a keyframe too.
  bool loses_much() const { return loses_much_ && frame_reason() == UNISIM_REASON_NONE; }
  /// The frame seen last is keyframe `id`. @return true when the whole state has been adjusted anew
  bool add_keyframe(int32_t id);
  /// What the newest keyframe has to do with places: it takes longer than the pose, and nobody
  /// waits for it. To be called when the pose has gone out; the next frame does it otherwise.
  void keep_place();
  /// Pose of the frame seen last.
  FramePose frame_pose();
  /// Adjusts the whole state one last time. @return true when it changed
  bool finish();
  /// Something worth telling since the last call, empty: nothing.
  std::string take_remark() { return std::exchange(remark_, std::string()); }
  /// Two segments have been put together, and the adjustment that makes them one map is not merged
  /// yet: what lies between does not fit.
  bool joining() const { return joining_ && background_.running(); }
  /// Precision of a window cut from the present state; 0 when not known.
  double window_sigma(const int32_t* ids, size_t count);

  /// Keyframes spread over the last adjustment of the whole state, and their precision.
  const std::vector<int32_t>& spread() const { return background_.spread(); }
  double spread_sigma() const { return background_.spread_sigma(); }

  const State& state() const { return state_; }
  const SpotTurns& turns() const { return turns_; }
  const MapperCounts& counts() const { return counts_; }
  const Places& places() const { return places_; }
  const StartStatistics& start_statistics() const { return start_; }
  int64_t bytes() const;

  /// Where in the map an image was taken; see Locator.
  bool locate(const unisim_image& image, PlaceFound* out, bool* followed) {
    return locator_.run(state_, patches_, image, &places_, out, followed);
  }

  /// Saves the map, or loads one into a mapper that has seen nothing; from there it goes on as one
  /// whose track was lost after the last keyframe. Throws drivers::ArchiveError.
  void archive(drivers::Archive* io);
  /// Is there a map worth saving?
  bool has_map() const;

 private:
  void archive_looks(drivers::Archive* io);
  /// Adds a remark that is made once in a run.
  void tell_once(bool* told, const std::string& what);
  void tell_zoom(int64_t frame);
  void tell_turn();
  void note_followed();
  /// Tracks lost since the last keyframe, where they are too many.
  void look_for_lost_tracks();
  /// The landmarks of the tracks are no longer followed.
  void let_go();
  void observe_tracks(size_t first);
  void detect_tracks();
  void try_start(int32_t id);
  void track(int32_t id);
  /// The newest keyframe's pose is known: it joins the map.
  void take_pose(int32_t id, const FramePose& found);
  void lose(int32_t id);
  /// Finds a lost camera in the map; what it sees of it is followed from then on.
  bool relocalise(int32_t id);
  bool waited_long() const;
  Places::Look look(int32_t id) const;
  /// Poses a keyframe that was lost when it was new, after a later one has been found.
  void recover(int32_t id, const CameraPose& near);
  void begin_segment(int32_t id);
  void adjust_window(int32_t id);
  void adjust_whole(int32_t id);
  /// Joins another segment to the present one where places have shown how they lie.
  bool join(int32_t id);
  void note_motion(int32_t id);

  State state_;
  FrontEnd front_end_;
  KeyframePose poses_;
  LandmarkGrowth growth_;
  Bootstrap bootstrap_;
  PatchStore patches_;
  PatchAtlas atlas_;
  Revive revive_;
  Remeasure remeasure_;
  Places places_;
  LostTracks lost_tracks_;
  PlaceFound found_;
  Locator locator_;
  std::vector<LoopObservation> loops_;
  std::vector<int32_t> joined_ids_;  // keyframes of the segment that was joined last
  ZoomWatch zoom_;
  SpotTurns turns_;
  MapAdjustment window_;
  BackgroundAdjustment background_;
  std::vector<int32_t> window_ids_;
  MapperCounts counts_;
  StartStatistics start_;  // until the first start
  std::string remark_;
  int64_t frame_ = 0;    // index of the frame seen last
  int64_t time_ns_ = 0;  // its time
  int64_t lost_since_ns_ = 0;
  Intrinsics lost_intrinsics_;  // of the map when the track was lost
  bool joining_ = false;        // the adjustment started last is that of a join
  bool zoom_told_ = false;
  bool turn_told_ = false;
  bool loses_much_ = false;
  bool after_keyframe_ = false;  // the frame seen last is one
  int lost_in_row_ = 0;
  int32_t unkept_ = -1;         // keyframe whose place has not been kept yet
  int32_t adjusted_posed_ = 0;  // keyframes posed when the whole state was last adjusted
};

}  // namespace unisim::geometric
