// SPDX-License-Identifier: MIT
// What a run gives out, kept on disk as it comes: memory does not grow with the length of the run.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/pose_history.hpp"
#include "drivers/pipeline/temporary_file.hpp"
#include "drivers/source.h"

namespace unisim::replay {

/// Listens to a run; run_data.hpp makes results of it at the end.
class RunRecord : public pipeline::Listener {
 public:
  /// @param folder for temporary files
  explicit RunRecord(const std::string& folder)
      : poses_(folder), keyframes_(folder), live_(folder), between_(folder), places_(folder) {}

  void on_keyframe(int32_t id, const unisim_frame& frame) override;
  void on_progress(const pipeline::Progress& progress) override;
  void on_window(int32_t submap_id, const unisim_window_prediction& window) override;
  void on_live_pose(const pipeline::LivePose& pose) override;
  void on_between_pose(const pipeline::BetweenPose& pose) override { between_.append(pose); }
  void on_retired(const unisim_retired& retired, const unisim_pose* pose) override {
    poses_.take(retired, pose);
  }

  void on_place(const unisim_place_report& look) override { places_.append(look); }

  const pipeline::RecordFile<unisim_place_report>& places() const { return places_; }
  const pipeline::RecordFile<unisim_stamped_pose>& live() const { return live_; }
  const pipeline::RecordFile<pipeline::BetweenPose>& between() const { return between_; }
  /// Poses of keyframes, kept by the session or not.
  const pipeline::PoseHistory& poses() const { return poses_; }

  /// Largest id of a submap that a window became, and one.
  int32_t submaps() const { return submaps_; }

  /// Index of the frame that became the keyframe, -1 if unknown.
  int64_t frame_of(int32_t keyframe) const { return keyframes_.get(keyframe).frame_index; }

  /// UNISIM_REASON_* when it was taken.
  int32_t reason_of(int32_t keyframe) const { return keyframes_.get(keyframe).reason; }

 private:
  struct Keyframe {
    int64_t frame_index = -1;
    int32_t reason = 0;
  };

  pipeline::PoseHistory poses_;
  pipeline::RecordFile<Keyframe> keyframes_;
  pipeline::RecordFile<unisim_stamped_pose> live_;
  pipeline::RecordFile<pipeline::BetweenPose> between_;
  pipeline::RecordFile<unisim_place_report> places_;
  int32_t submaps_ = 0;
  int32_t newest_ = -1;  // keyframe whose reason is still to come
};

}  // namespace unisim::replay
