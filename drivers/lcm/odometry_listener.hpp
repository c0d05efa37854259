// SPDX-License-Identifier: MIT
// Poses of an odometer that come over LCM, for a run that is to be in metres.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/pipeline/distance_inbox.hpp"

namespace unisim::lcm {

struct OdometryListenerConfig {
  std::string url;            ///< "": UNISIM_LCM_DEFAULT_URL
  std::string channel;        ///< of bot_core.pose_t
  double common_sigma = 0.0;  ///< relative error that all of the odometry shares
};

struct OdometryCounts {
  int64_t taken = 0;    ///< poses
  int64_t foreign = 0;  ///< messages of other types, or with numbers that are none
  int64_t refused = 0;  ///< poses that are not later than the one before, or found no room
};

/// A thread that hands what it hears to an inbox, positions only. Times are those of the messages:
/// on the clock of the frames.
class OdometryListener {
 public:
  /// @param inbox borrowed. Throws LcmError.
  OdometryListener(const OdometryListenerConfig& config, pipeline::DistanceInbox* inbox);
  ~OdometryListener();
  OdometryListener(const OdometryListener&) = delete;
  OdometryListener& operator=(const OdometryListener&) = delete;

  /// From any thread.
  OdometryCounts counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace unisim::lcm
