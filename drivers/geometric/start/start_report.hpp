// SPDX-License-Identifier: MIT
// The one line about a run that found no start: what was seen, why it was refused, what would help.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "drivers/geometric/start/start_statistics.hpp"

namespace unisim::geometric {

inline constexpr const char* kTwoEyes =
    "the left and right halves look alike, as of two eyes side by side: give the images of one eye";

/// UNISIM_REASON_* of what a keyframe lacked for a start; _NONE where it lacked nothing of its own.
int32_t start_reason(StartOutcome outcome);

std::string start_report(const StartStatistics& seen, const cv::Size& size);

}  // namespace unisim::geometric
