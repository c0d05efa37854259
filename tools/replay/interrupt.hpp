// SPDX-License-Identifier: MIT
// Ctrl-C and termination as a flag.
#pragma once

#include <atomic>

namespace unisim::replay {

/// Raised by the first SIGINT, SIGTERM or SIGHUP; a second SIGINT or SIGTERM ends the program at
/// once. A terminal that closes may say so more than once. SIGHUP that the caller ignores (nohup)
/// stays ignored.
const std::atomic<bool>& catch_interrupts();

}  // namespace unisim::replay
