// SPDX-License-Identifier: MIT
// Snapshots in memory, and damage done to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"
#include "unisim/unisim.h"

namespace unisim::test {

/// Where a snapshot is written to and read from; memory may be reserved before.
struct SnapshotBytes {
  std::vector<unsigned char> bytes;
  size_t read = 0;
  size_t limit = SIZE_MAX;  ///< of what can be written

  static int32_t write(void* context, const void* from, size_t size) {
    auto* self = static_cast<SnapshotBytes*>(context);
    if (self->bytes.size() + size > self->limit) return 0;
    const auto* data = static_cast<const unsigned char*>(from);
    self->bytes.insert(self->bytes.end(), data, data + size);
    return 1;
  }
  static int32_t take(void* context, void* to, size_t size) {
    auto* self = static_cast<SnapshotBytes*>(context);
    if (self->bytes.size() - self->read < size) return 0;
    std::memcpy(to, self->bytes.data() + self->read, size);
    self->read += size;
    return 1;
  }
};

inline SnapshotBytes save(const unisim_session* session) {
  SnapshotBytes out;
  REQUIRE(unisim_save_map(session, SnapshotBytes::write, &out) == UNISIM_OK);
  return out;
}

inline unisim_status load(unisim_session* session, SnapshotBytes* snapshot) {
  snapshot->read = 0;
  return unisim_load_map(session, SnapshotBytes::take, snapshot);
}

inline unisim_load_report load_report(const unisim_session* session) {
  unisim_load_report report = {};
  report.struct_size = sizeof report;
  REQUIRE(unisim_get_load_report(session, &report) == UNISIM_OK);
  return report;
}

}  // namespace unisim::test
