// SPDX-License-Identifier: MIT
// Counts the calls of the malloc family in this process.
#pragma once

#include <cstdint>

namespace unisim::test {

/// Calls of malloc, calloc, realloc, free, posix_memalign, aligned_alloc, memalign since the start;
/// operator new and delete end in these.
int64_t heap_calls();

}  // namespace unisim::test
