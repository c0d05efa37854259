// SPDX-License-Identifier: MIT
// The map of a session saved, and loaded into another one: bytes and times.
#pragma once

#include <cstddef>

#include "drivers/pipeline/heap_watch.hpp"
#include "unisim/unisim.h"

namespace unisim::bench {

/// Times are process CPU time [ms].
struct SnapshotResult {
  size_t bytes = 0;
  double save_ms = 0.0;
  double load_ms = 0.0;
};

/// @param config of the session
/// @throws tools::Failure when the session refuses a call, or the map loaded saves other bytes
SnapshotResult run_snapshot(const unisim_session* session, const unisim_config& config,
                            const pipeline::HeapWatch& heap);

}  // namespace unisim::bench
