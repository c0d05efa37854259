// SPDX-License-Identifier: MIT
// The status line of a live run.
#pragma once

#include <string>

#include "drivers/pipeline/listener.hpp"
#include "tools/live/figures.hpp"
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
  const PoseAge* ages_;
  FrameRate rate_;
};

/// What came of the ages of a run, a line.
std::string age_text(const pipeline::LatencyHistogram& ages);

}  // namespace unisim::live
