// SPDX-License-Identifier: MIT
// How old a pose is when it is given out.
#include "tools/live/pose_age.hpp"

#include <algorithm>
#include <chrono>

namespace unisim::live {

int64_t monotonic_ns() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

void PoseAge::on_live_pose(const pipeline::LivePose& pose) {
  if (pose.late) return;
  const int64_t now = monotonic_ns();
  if (!known_) {
    const int64_t offset = pose.timestamp_ns - now;
    offset_ns_ = started_ ? std::max(offset_ns_, offset) : offset;
    started_ = true;
  }
  constexpr double kNsPerMs = 1e6;
  ages_.add_ms(static_cast<double>(now + offset_ns_ - pose.timestamp_ns) / kNsPerMs);
}

}  // namespace unisim::live
