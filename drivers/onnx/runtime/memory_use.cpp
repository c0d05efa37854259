// SPDX-License-Identifier: MIT
// Memory of the machine and of this process, as Linux tells it.
#include "drivers/onnx/runtime/memory_use.hpp"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <string>

namespace unisim::onnx {
namespace {

/// A line "Name:  123 kB" of /proc/self/status, in bytes; -1 where there is none.
int64_t status_bytes(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    int64_t kilobytes = 0;
    if (word == name && file >> kilobytes) return kilobytes << 10;
  }
  return -1;
}

// The mark is one for the process, and so is what it said before it was reset.
std::atomic<int64_t> highest_mark{0};

/// Makes the high-water mark start anew. Where the system forbids it, growth counts from the old
/// mark.
void reset_peak() {
  highest_mark = std::max(highest_mark.load(), status_bytes("VmHWM:"));
  std::ofstream file("/proc/self/clear_refs");
  file << "5";
}

}  // namespace

int64_t machine_memory_bytes() {
  const int64_t all = int64_t{sysconf(_SC_PHYS_PAGES)} * int64_t{sysconf(_SC_PAGESIZE)};
  std::ifstream file("/sys/fs/cgroup/memory.max");
  int64_t limit = 0;
  return file >> limit ? std::min(all, limit) : all;
}

int64_t peak_growth_bytes(const std::function<void()>& work) {
#ifdef __GLIBC__
  // What an earlier inference freed would otherwise be taken again without being seen.
  malloc_trim(0);
#endif
  reset_peak();
  const int64_t before = status_bytes("VmRSS:");
  work();
  const int64_t peak = status_bytes("VmHWM:");
  return before < 0 || peak < 0 ? 0 : std::max<int64_t>(peak - before, 0);
}

int64_t peak_before_reset_bytes() { return highest_mark; }

int32_t views_within(int64_t budget, int32_t first, int32_t wanted,
                     const std::function<int64_t(int32_t)>& measure) {
  int32_t views = first;
  int64_t bytes = measure(views);
  while (views < wanted && bytes <= budget) {
    const double room =
        static_cast<double>(budget) / static_cast<double>(std::max<int64_t>(bytes, 1));
    const double bound = std::floor(views * std::sqrt(room));
    const int32_t next = static_cast<int32_t>(std::min<double>(bound, wanted));
    if (next <= views) break;
    const int64_t taken = measure(next);
    if (taken > budget) break;
    bytes = taken;
    views = next;
  }
  return views;
}

}  // namespace unisim::onnx
