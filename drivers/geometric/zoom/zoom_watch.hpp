// SPDX-License-Identifier: MIT
// Notices a camera that zooms while it films: its map would be bent without a word.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/bundle/pose_solver.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

/// Looks at how the tracks moved from keyframe to keyframe, at points whose depth the map knows.
///
/// Going ahead makes near things grow faster than far ones, a zoom makes all of them grow alike:
/// the pose is solved with the focal length of the map and with one of its own, and a zoom is where
/// the second fits clearly better, keyframe after keyframe in the same direction. A map that is
/// wrong by some percent shows up in both keyframes alike, so that it hardly matters.
class ZoomWatch {
 public:
  void reserve(size_t tracks) { observations_.reserve(tracks); }
  /// The state holds keyframe id - 1; its tracks are measured in keyframe `id`, whose pose is not
  /// known yet. @return true when the camera has zoomed since `begin()`
  bool see_keyframe(const State& state, int32_t id, int64_t frame);
  /// Frame of the first keyframe of the zoom.
  int64_t begin() const { return begin_; }
  /// The keyframe seen last looks zoomed, which alone proves nothing.
  bool suspects() const { return keyframes_ > 0; }

 private:
  bool collect(const State& state, int32_t id);
  double cost(const State& state, double log_ratio);
  double best_log_ratio(const State& state);
  bool zooms(const State& state, double* log_ratio);

  std::vector<PoseObservation> observations_;  // in the camera of the keyframe before
  CameraPose pose_;                            // of the last solve
  double total_ = 0;  // log of the focal lengths' ratio over the keyframes in a row that zoom
  int32_t keyframes_ = 0;
  int64_t begin_ = 0;
};

}  // namespace unisim::geometric
