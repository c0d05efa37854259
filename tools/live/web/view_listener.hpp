// SPDX-License-Identifier: MIT
// Looks on while a run goes, and hands what the page shows to the feed.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/pipeline.hpp"
#include "drivers/pipeline/pose_history.hpp"
#include "tools/live/figures.hpp"
#include "tools/live/pose_age.hpp"
#include "tools/live/web/feed.hpp"
#include "tools/live/web/thinned_series.hpp"
#include "tools/live/web/view.hpp"

namespace unisim::live::web {

/// On the thread of the tracking, which it never holds: while nobody looks at the page it keeps
/// coarse trajectories and a few points; else it copies ten images a second, and brings a few poses
/// up to date with each frame.
class ViewListener : public pipeline::Listener {
 public:
  /// @param feed, ages borrowed
  /// @param folder for a temporary file of old poses
  ViewListener(Feed* feed, const PoseAge* ages, const std::string& folder);

  /// Before the first frame. @param pipeline, predictor borrowed until the end of the run
  void attach(const pipeline::Pipeline* pipeline, unisim_predictor* predictor);

  void on_live_pose(const pipeline::LivePose& pose) override;
  void on_keyframe_pose(const unisim_pose& keyframe) override;
  void on_frame(const unisim_frame& frame) override;
  void on_window(int32_t submap_id, const unisim_window_prediction& window) override;
  void on_retired(const unisim_retired& retired, const unisim_pose* pose) override;
  void on_progress(const pipeline::Progress& progress) override;
  void on_message(const std::string& line) override;

 private:
  using Clock = std::chrono::steady_clock;

  bool read(int32_t keyframe, unisim_pose* pose) const;
  void take_image(const unisim_frame& frame);
  void take_status(const pipeline::Progress& progress);
  void take_map();
  void refresh();
  void refresh_patch(CloudPatch* patch);

  Feed* feed_;
  const PoseAge* ages_;
  const pipeline::Pipeline* pipeline_ = nullptr;
  unisim_predictor* predictor_ = nullptr;
  pipeline::PoseHistory history_;
  FrameRate rate_;
  ThinnedSeries<PathPoint> live_{kPathPoints};
  ThinnedSeries<PathPoint> corrected_{kPathPoints};
  ThinnedSeries<CloudPatch> cloud_{kCloudPatches};
  PathPoint newest_;       // pose given out last
  int64_t posed_ns_ = -1;  // its time stamp
  int32_t confidence_ = 0;
  size_t next_point_ = 0;  // to be brought up to date
  size_t next_patch_ = 0;
  int32_t image_width_ = 0;
  int32_t image_height_ = 0;
  std::vector<float> xyz_;
  std::deque<std::string> messages_;
  View view_;  // in work
  Clock::time_point next_view_{};
  Clock::time_point next_map_{};
};

}  // namespace unisim::live::web
