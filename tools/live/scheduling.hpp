// SPDX-License-Identifier: MIT
// How the system runs this process: priority, processors, memory.
#pragma once

#include <optional>
#include <vector>

namespace unisim::live {

inline constexpr int kMostCpus = 1024;

struct Scheduling {
  std::optional<int> priority;  ///< of SCHED_FIFO
  std::vector<int> cpus;        ///< empty: all
  bool lock_memory = false;
};

/// Applies it to this thread and those it starts. Throws Failure (4): the system does not allow it,
/// with the command that lets it; (2): no such processor.
void apply(const Scheduling& scheduling);

/// This thread, and those it starts, have no real-time priority: what must not hold tracking, and
/// yet has to be done in time.
void share_as_usual();

/// This thread, and those it starts, run when the tracking leaves time: usual sharing, less of it.
void give_way();

}  // namespace unisim::live
