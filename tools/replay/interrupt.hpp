// SPDX-License-Identifier: MIT
// Ctrl-C and termination as a flag.
#pragma once

#include <atomic>

namespace unisim::replay {

/// Raised by the first SIGINT or SIGTERM; a second one ends the program at once.
const std::atomic<bool>& catch_interrupts();

}  // namespace unisim::replay
