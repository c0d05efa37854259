// SPDX-License-Identifier: MIT
// What this process has used: CPU time and memory.
#include "tools/bench/process.hpp"

#include <time.h>

#include <fstream>
#include <string>

namespace unisim::bench {

double process_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// VmHWM and not getrusage(): the latter carries over the peak of the parent from before exec().
int64_t peak_resident_kb() {
  std::ifstream status("/proc/self/status");
  std::string key;
  while (status >> key) {
    int64_t kb = 0;
    if (key == "VmHWM:" && status >> kb) return kb;
  }
  return 0;
}

}  // namespace unisim::bench
