// SPDX-License-Identifier: MIT
// The status line of a live run.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "drivers/pipeline/listener.hpp"
#include "tools/live/pose_age.hpp"

namespace unisim::live {

/// Makes the line of where the run stands: state, rate, age of the poses, frames given up, map,
/// memory, temperature.
class StatusText {
 public:
  /// @param ages borrowed
  explicit StatusText(const PoseAge* ages) : ages_(ages) {}

  std::string operator()(const pipeline::Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  double rate(int64_t frames);

  const PoseAge* ages_;
  Clock::time_point rate_since_ = Clock::now();
  int64_t frames_then_ = 0;
  double frames_per_second_ = 0.0;
};

/// Warmest part of the board, degrees Celsius; < 0 when it does not tell.
/// @param folder of the kernel's thermal zones
double temperature_c(const std::string& folder = "/sys/class/thermal");

}  // namespace unisim::live
