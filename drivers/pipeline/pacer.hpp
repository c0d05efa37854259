// SPDX-License-Identifier: MIT
// Holds a recorded sequence to the times it was recorded at.
#pragma once

#include <chrono>
#include <cstdint>

namespace unisim::pipeline {

/// For realtime runs: waits for frames that are early, drops those that are late.
class Pacer {
 public:
  /// Waits until the frame is due.
  /// @return false when it is more than one frame interval late and must be dropped
  bool keep(int64_t timestamp_ns);

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point start_{};
  int64_t first_timestamp_ns_ = 0;
  int64_t last_timestamp_ns_ = 0;
  bool started_ = false;
};

}  // namespace unisim::pipeline
