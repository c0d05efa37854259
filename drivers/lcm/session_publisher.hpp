// SPDX-License-Identifier: MIT
// A listener that tells a run of the pipeline over LCM.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/lcm/publisher.h"
#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/pipeline.hpp"
#include "drivers/pipeline/pose_history.hpp"

namespace unisim::lcm {

struct SessionPublisherOptions {
  bool images = false;            ///< UNISIM_IMAGE: each frame, after its pose
  int32_t points_per_submap = 0;  ///< UNISIM_POINTS; 0: none
  bool covariance = true;         ///< of keyframes: a factorisation for each new submap
  std::string folder;             ///< for a temporary file of old poses, "" for memory
};

/// What is sent is in metres from the time on at which the session knows how long one is; before
/// that in the map's unit. The change is told as a correction whose jump scales all, as is each
/// later one of the metre.
///
/// Reads the session. With options.covariance the graph is factorised more often, which rounds
/// differently: poses may differ from those of a run without in the eighth digit; otherwise they
/// are the same bits.
class SessionPublisher : public pipeline::Listener {
 public:
  /// @param publisher borrowed; it must outlive this
  SessionPublisher(unisim_lcm_publisher* publisher, const SessionPublisherOptions& options);

  /// To be called between the making of the pipeline and its run().
  /// @param pipeline borrowed, in use until finish()
  void attach(const pipeline::Pipeline* pipeline) { pipeline_ = pipeline; }

  /// After the run: the whole trajectory and a last status.
  void finish();

  void on_keyframe(int32_t id, const unisim_frame& frame) override;
  void on_frame(const unisim_frame& frame) override;
  void on_live_pose(const pipeline::LivePose& pose) override;
  void on_keyframe_pose(const unisim_pose& keyframe) override;
  void on_window(int32_t submap_id, const unisim_window_prediction& window) override;
  void on_optimized(const unisim_report& report) override;
  void on_retired(const unisim_retired& retired, const unisim_pose* pose) override;
  void on_progress(const pipeline::Progress& progress) override;

 private:
  using Clock = std::chrono::steady_clock;

  /// Keyframes that are to go out as UNISIM_TRAJECTORY, from `next` to before `end`.
  struct Trajectory {
    int32_t next = 0;
    int32_t end = 0;
    int32_t chunk = 0;
    int32_t chunks = 0;
  };

  /// A keyframe where it is today, in the map's unit.
  bool read_pose(int32_t keyframe, unisim_pose* pose) const;
  /// How long the unit of a segment is, as those who listen have it.
  pipeline::Metre metre_of(int32_t segment) const;
  /// The unit of what is sent next.
  void say_unit(const pipeline::Metre& metre);
  bool metre_known() const { return metre_.per_unit > 0.0; }
  int32_t revision() const { return revision_ + unit_changes_; }
  bool read_info(unisim_session_info* info) const;
  void send_correction(const unisim_report& report, bool metre_only);
  void send_optimized_keyframes();
  void send_points(int32_t submap_id, const unisim_window_prediction& window);
  void begin_trajectory(int32_t first);
  pipeline::Metre poses_in_metres();
  void send_trajectory_chunk();
  void send_status(const pipeline::Progress& progress);
  void fill_stages();

  unisim_lcm_publisher* publisher_;
  SessionPublisherOptions options_;
  const pipeline::Pipeline* pipeline_ = nullptr;
  pipeline::PoseHistory history_;
  int32_t image_width_ = 0;
  int32_t image_height_ = 0;
  int64_t newest_ns_ = 0;  // pose sent last
  unisim_pose live_{};     // newest keyframe, where those who listen have it; struct_size 0: none
  pipeline::Metre metre_;  // of its segment, as they have it
  int32_t revision_ = 0;   // of the map they have it in
  int32_t unit_changes_ = 0;  // corrections that only said how long a metre is
  int32_t loops_ = 0;         // when the trajectory was sent last
  int32_t next_covered_ = 0;  // oldest keyframe not sent from a submap yet
  int32_t last_windowed_ = -1;
  Trajectory trajectory_;
  std::vector<unisim_pose> poses_;  // of one message
  std::vector<float> xyz_;
  std::vector<unisim_lcm_stage> stages_;
  int32_t told_state_ = -1;
  int32_t told_reason_ = 0;
  bool told_metric_ = false;
  int32_t told_segment_ = -1;
  Clock::time_point next_status_{};
};

}  // namespace unisim::lcm
