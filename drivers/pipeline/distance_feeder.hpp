// SPDX-License-Identifier: MIT
// Distances between keyframes out of odometry, for a session.
#pragma once

#include <cstdint>

#include "drivers/pipeline/distance_inbox.hpp"
#include "drivers/pipeline/messages.hpp"
#include "drivers/pipeline/odometry.hpp"
#include "drivers/pipeline/session_client.hpp"

namespace unisim::pipeline {

/// Of a wheel that measures the path alone: the slip and the wear of a wheel, and the jitter that
/// makes the path of what was measured longer than the way.
inline constexpr double kPathCommonSigma = 0.05;

/// Where distances come from; nothing of it is owned.
struct OdometryOptions {
  const Odometry* odometry = nullptr;  ///< of a file; NULL: none
  double sigma = 0.02;                 ///< standard deviation over the path
  double common_sigma = 0.0;           ///< relative error that all of it shares
  DistanceInbox* inbox = nullptr;      ///< what comes while the run goes; NULL: nothing
};

/// Chords of a quarter of a window, one after the other: long enough that the window sees them
/// well, short enough that most are free of slips where wheels slip now and then, and no metre of
/// the way counts twice. Wheels that know no direction measure the path; how much shorter the chord
/// is, the map says, which does not need to know its scale for that.
class DistanceFeeder {
 public:
  /// @param window_size of the session
  DistanceFeeder(SessionClient* session, const OdometryOptions& options, int32_t window_size,
                 Messages* messages)
      : session_(session),
        messages_(messages),
        options_(options),
        span_(window_size / 4 > 1 ? window_size / 4 : 1) {}

  /// A keyframe has come. What a session was loaded with before the first is of another run, whose
  /// times mean nothing here.
  void note_keyframe(int32_t keyframe) {
    if (next_ < 0) next_ = keyframe;
  }
  /// Keyframes up to this one have the pose they get from their pair. Those that odometry of the
  /// inbox has not reached wait.
  void settle(int32_t keyframe);

 private:
  void take_inbox();
  void pass_on(const unisim_distance& distance);
  const Odometry* odometry() const;
  void take(int32_t keyframe);
  void begin(int32_t keyframe, const unisim_pose& pose, const Travelled& travelled);
  void add(const unisim_pose& pose, const Travelled& travelled);

  SessionClient* session_;
  Messages* messages_;
  OdometryOptions options_;
  int32_t span_;
  int32_t next_ = -1;   // keyframe not looked at yet, -1: before the first
  int32_t first_ = -1;  // of the chord being measured, -1: none
  unisim_pose first_pose_{};
  unisim_pose last_pose_{};
  Travelled first_travelled_;
  double map_path_ = 0.0;  // length of the way on the map, its unit
  Odometry live_;          // of the inbox
  DistanceInbox::Content taken_;
};

}  // namespace unisim::pipeline
