// SPDX-License-Identifier: MIT
// Distances between keyframes out of odometry, for a session.
#pragma once

#include <cstdint>

#include "drivers/pipeline/odometry.hpp"
#include "drivers/pipeline/session_client.hpp"

namespace unisim::pipeline {

/// Where distances come from; nothing of it is owned.
struct OdometryOptions {
  const Odometry* odometry = nullptr;  ///< NULL: none
  double sigma = 0.02;                 ///< standard deviation over the path
};

/// Chords of half a window, one after the other: long enough that the window sees them well, and no
/// metre of the way counts twice. Wheels that know no direction measure the path; how much shorter
/// the chord is, the map says, which does not need to know its scale for that.
class DistanceFeeder {
 public:
  /// @param window_size of the session
  DistanceFeeder(SessionClient* session, const OdometryOptions& options, int32_t window_size)
      : session_(session), options_(options), span_(window_size / 2 > 1 ? window_size / 2 : 1) {}

  /// A keyframe has come. What a session was loaded with before the first is of another run, whose
  /// times mean nothing here.
  void note_keyframe(int32_t keyframe) {
    if (next_ < 0) next_ = keyframe;
  }
  /// Keyframes up to this one have the pose they get from their pair.
  void settle(int32_t keyframe);

 private:
  void take(int32_t keyframe);
  void begin(int32_t keyframe, const unisim_pose& pose, const Travelled& travelled);
  void add(const unisim_pose& pose, const Travelled& travelled);

  SessionClient* session_;
  OdometryOptions options_;
  int32_t span_;
  int32_t next_ = -1;   // keyframe not looked at yet, -1: before the first
  int32_t first_ = -1;  // of the chord being measured, -1: none
  unisim_pose first_pose_{};
  unisim_pose last_pose_{};
  Travelled first_travelled_;
  double map_path_ = 0.0;  // length of the way on the map, its unit
};

}  // namespace unisim::pipeline
