// SPDX-License-Identifier: MIT
// CRC-32 as zip files and Ethernet have it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace unisim {

/// Checksum of bytes that come in pieces: polynomial 0x04c11db7 reflected, all ones at both ends.
class Crc32 {
 public:
  void add(const unsigned char* bytes, size_t count);
  uint32_t value() const { return ~state_; }

 private:
  uint32_t state_ = 0xffffffffU;
};

}  // namespace unisim
