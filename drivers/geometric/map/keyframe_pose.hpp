// SPDX-License-Identifier: MIT
// Pose of the present frame from the landmarks its tracks belong to.
#pragma once

#include <vector>

#include "drivers/geometric/bundle/pose_solver.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

/// A pose and how well the tracks agree with it.
struct FramePose {
  bool good = false;
  CameraPose pose;
  int inliers = 0;
  int used = 0;
  double center_sigma = 0;  ///< standard deviation of the centre over median depth, landmarks known
};

class KeyframePose {
 public:
  void reserve(size_t count);

  /// Pose of frame `id` (the newest keyframe or one that will get this id) from the live tracks.
  /// Tries the last pose and constant velocity; RANSAC only when both fail.
  FramePose solve_new(const State& state, int32_t id);
  /// Refines a pose with the tracks there are now (after some were revived).
  FramePose refine(const State& state, const CameraPose& start);
  /// Pose of a keyframe in the map from its observations, starting at `start`.
  FramePose solve_old(const State& state, int32_t keyframe, const CameraPose& start);

 private:
  void collect_tracks(const State& state);
  FramePose finish(const State& state, const CameraPose& start, int iterations);
  CameraPose best_start(const State& state, int32_t id) const;
  bool ransac(const State& state, CameraPose* pose) const;
  PoseOptions options(const State& state, double cauchy, double inlier, int iterations) const;

  std::vector<PoseObservation> observations_;
};

}  // namespace unisim::geometric
