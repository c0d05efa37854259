// SPDX-License-Identifier: MIT
// The one line about a run that found no start: what was seen, why it was refused, what would help.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "drivers/geometric/start/start_statistics.hpp"

namespace unisim::geometric {

inline constexpr const char* kTwoEyes =
    "the left and right halves look alike, as of two eyes side by side: give the images of one eye";

std::string start_report(const StartStatistics& seen, const cv::Size& size);

}  // namespace unisim::geometric
