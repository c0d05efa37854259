// SPDX-License-Identifier: MIT
// The head of a map file: magic, version, then name, size and checksum of each part, then its own
// checksum. Little-endian.
#pragma once

#include <cstddef>
#include <cstdint>

namespace unisim::mapfile {

// What a transfer as text would change is in it.
inline constexpr unsigned char kMagic[8] = {0x89, 'u', 'n', 'i', 'm', 'a', 'p', '\n'};
inline constexpr uint32_t kVersion = 1;
inline constexpr uint32_t kMostSections = 64;
inline constexpr size_t kNameBytes = 16;
inline constexpr size_t kFixedBytes = sizeof kMagic + 4 + 4;  ///< magic, version, number of parts
inline constexpr size_t kEntryBytes = kNameBytes + 8 + 4;     ///< name, size, CRC-32C
inline constexpr size_t kSumBytes = 4;                        ///< CRC-32C of all before it

constexpr size_t head_bytes(size_t sections) {
  return kFixedBytes + sections * kEntryBytes + kSumBytes;
}

}  // namespace unisim::mapfile
