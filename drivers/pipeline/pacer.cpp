// SPDX-License-Identifier: MIT
// Holds a recorded sequence to the times it was recorded at.
#include "drivers/pipeline/pacer.hpp"

#include <thread>

namespace unisim::pipeline {

bool Pacer::keep(int64_t timestamp_ns) {
  if (!started_) {
    started_ = true;
    start_ = Clock::now();
    first_timestamp_ns_ = last_timestamp_ns_ = timestamp_ns;
    return true;
  }
  const std::chrono::nanoseconds interval(timestamp_ns - last_timestamp_ns_);
  const Clock::time_point due =
      start_ + std::chrono::nanoseconds(timestamp_ns - first_timestamp_ns_);
  last_timestamp_ns_ = timestamp_ns;
  if (Clock::now() > due + interval) return false;
  std::this_thread::sleep_until(due);
  return true;
}

}  // namespace unisim::pipeline
