// SPDX-License-Identifier: MIT
// What the system says of a live run: rate, memory, temperature.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace unisim::live {

/// Frames per second over the last second or so.
class FrameRate {
 public:
  /// @param frames so far
  double update(int64_t frames);

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point since_ = Clock::now();
  int64_t frames_then_ = 0;
  double per_second_ = 0.0;
};

/// Memory the process holds now.
int64_t resident_bytes();

/// Warmest part of the board, degrees Celsius; < 0 when it does not tell.
/// @param folder of the kernel's thermal zones
double temperature_c(const std::string& folder = "/sys/class/thermal");

}  // namespace unisim::live
