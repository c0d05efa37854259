// SPDX-License-Identifier: MIT
// What a host says of lengths while a run goes, on its way to the pipeline's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "drivers/pipeline/odometry.hpp"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// From any threads; taken by one.
class DistanceInbox {
 public:
  /// Of each kind between two keyframes; beyond, the newest is refused.
  static constexpr size_t kMost = 8192;

  /// @return false: it begins before the last one ended, or there is no room
  bool add(const OdometryStep& step, double common_sigma);
  /// In place of steps. @return false: it is not later than the last one, or there is no room
  bool add(const OdometryPosition& position, double common_sigma);
  /// @return false: there is no room
  bool add(const unisim_distance& distance);

  struct Content {
    std::vector<OdometryStep> steps;
    std::vector<OdometryPosition> positions;
    std::vector<unisim_distance> distances;
  };

  /// Takes all out, in order. @param[out] common_sigma largest that was given so far
  void take(Content* content, double* common_sigma);

 private:
  std::mutex mutex_;
  Content content_;
  int64_t end_ns_ = INT64_MIN;  // of the newest step or position
  double common_sigma_ = 0.0;
};

}  // namespace unisim::pipeline
