// SPDX-License-Identifier: MIT
// Ctrl-C and termination as a flag.
#pragma once

#include <atomic>

namespace unisim::replay {

/// Raised by the first SIGINT or SIGTERM; a second one ends the program at once.
/// Files over a size limit give a write error from here on, not a signal.
const std::atomic<bool>& catch_interrupts();

}  // namespace unisim::replay
