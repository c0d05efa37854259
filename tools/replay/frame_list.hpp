// SPDX-License-Identifier: MIT
// The frames of a sequence, for programs that read the same images.
#pragma once

#include <atomic>

#include "tools/replay/options.hpp"

namespace unisim::replay {

/// Prints one JSON object a line: index, time_ns, time, format, file, and what has to be done to
/// the pixels. Frames that come at no time of their own are left out and said. Throws Failure.
/// @return exit code
int list_frames(const Options& options, const std::atomic<bool>& stop);

}  // namespace unisim::replay
