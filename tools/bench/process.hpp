// SPDX-License-Identifier: MIT
// What this process has used: CPU time and memory.
#pragma once

#include <cstdint>

namespace unisim::bench {

/// CPU time of the process [ms], all threads: other load on the machine does not count.
double process_cpu_ms();

/// Largest resident size so far [kB]; 0 where the system does not tell.
int64_t peak_resident_kb();

}  // namespace unisim::bench
