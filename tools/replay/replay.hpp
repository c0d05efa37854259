// SPDX-License-Identifier: MIT
// One run of unisim-replay.
#pragma once

#include <atomic>

#include "tools/replay/options.hpp"

namespace unisim::replay {

/// Runs, writes the results, prints the summary. Throws Failure before anything is computed.
/// @return exit code
int replay(const Options& options, const std::atomic<bool>& stop);

}  // namespace unisim::replay
