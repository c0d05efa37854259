// SPDX-License-Identifier: MIT
// Holds a recorded sequence to the times it was recorded at.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace unisim::pipeline {

/// For realtime runs: waits for frames that are early, drops those that are late.
class Pacer {
 public:
  /// Waits until the frame is due, or `stop` is raised.
  /// @param stop may be NULL
  /// @return false when it is more than one frame interval late and must be dropped
  bool keep(int64_t timestamp_ns, const std::atomic<bool>* stop);

 private:
  using Clock = std::chrono::steady_clock;

  int64_t elapsed_ns() const;

  Clock::time_point start_{};
  int64_t first_timestamp_ns_ = 0;
  int64_t last_timestamp_ns_ = 0;
  bool started_ = false;
};

}  // namespace unisim::pipeline
