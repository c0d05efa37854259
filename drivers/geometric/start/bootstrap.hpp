// SPDX-License-Identifier: MIT
// Starts a segment: two keyframes far enough apart give the first poses and landmarks.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/map/keyframe_pose.hpp"
#include "drivers/geometric/map/landmark_growth.hpp"
#include "drivers/geometric/map/map_adjustment.hpp"
#include "drivers/geometric/map/state.hpp"
#include "drivers/geometric/start/start_statistics.hpp"

namespace unisim::geometric {

class Bootstrap {
 public:
  void reserve(size_t tracks);
  /// Forgets the reference: the next keyframe begins anew.
  void restart(int32_t keyframe) { reference_ = keyframe; }

  /// Tries to start with keyframe `id`, the newest. On success every keyframe of the segment that
  /// can be is posed, in a unit where the median depth is 1.
  StartOutcome attempt(State* state, int32_t id, MapAdjustment* adjustment, LandmarkGrowth* growth,
                       KeyframePose* poses);

 private:
  void correspondences(const State& state, int32_t id);
  StartOutcome relative_pose(State* state, int32_t id);
  int place_landmarks(State* state, int32_t id, double* median_parallax);
  void set_unit(State* state, int32_t id);
  void pose_between(State* state, int32_t id, KeyframePose* poses);
  void pose_before(State* state, KeyframePose* poses);
  bool adjust(State* state, int32_t id, MapAdjustment* adjustment, LandmarkGrowth* growth,
              KeyframePose* poses);
  void adjust_posed(State* state, int iterations, double gate, MapAdjustment* adjustment);
  void undo(State* state, int32_t id);

  int32_t reference_ = 0;
  std::vector<cv::Point2f> from_;
  std::vector<cv::Point2f> to_;
  std::vector<int32_t> landmarks_;
  std::vector<uint8_t> inlier_;
  std::vector<int32_t> posed_;
};

}  // namespace unisim::geometric
