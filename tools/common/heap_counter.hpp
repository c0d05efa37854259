// SPDX-License-Identifier: MIT
// Counts the heap calls made while a thread is inside libunisim.
#pragma once

#include "drivers/pipeline/heap_watch.hpp"

namespace unisim::tools {

/// Hooks of this program's malloc family; empty where it cannot be intercepted (sanitizers).
pipeline::HeapWatch heap_counter();

}  // namespace unisim::tools
