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

/// A section of a snapshot: header (name 8, version 4, checksum 4, size 8), then payload.
struct SnapshotSection {
  std::string name;
  size_t header = 0;
  size_t payload = 0;
  size_t end = 0;
};

inline std::vector<SnapshotSection> sections_of(const std::vector<unsigned char>& bytes) {
  std::vector<SnapshotSection> sections;
  for (size_t at = 12; at + 24 <= bytes.size(); at = sections.back().end) {
    SnapshotSection section;
    section.name.assign(reinterpret_cast<const char*>(&bytes[at]), 8);
    section.name.resize(std::strlen(section.name.c_str()));
    section.header = at;
    section.payload = at + 24;
    size_t size = 0;
    for (int k = 7; k >= 0; --k) size = (size << 8) | bytes[at + 16 + static_cast<size_t>(k)];
    section.end = section.payload + size;
    sections.push_back(section);
  }
  return sections;
}

/// CRC-32, bit by bit.
inline uint32_t checksum(const unsigned char* bytes, size_t count, uint32_t state = 0xffffffffU) {
  for (size_t i = 0; i < count; ++i) {
    state ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) state = (state >> 1) ^ ((state & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return state;
}

/// Make the checksum of a section right again.
inline void seal(const SnapshotSection& section, std::vector<unsigned char>* bytes) {
  unsigned char* header = bytes->data() + section.header;
  uint32_t state = checksum(bytes->data() + section.payload, section.end - section.payload);
  state = checksum(header + 16, 8, checksum(header, 12, state));
  for (int k = 0; k < 4; ++k) header[12 + k] = static_cast<unsigned char>(~state >> (8 * k));
}

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
