// SPDX-License-Identifier: MIT
// CRC-32 as zip files and Ethernet have it.
#include "core/snapshot/crc32.hpp"

#include <array>

namespace unisim {
namespace {

/// What eight zero bits behind each byte make of the checksum.
constexpr std::array<uint32_t, 256> make_table() {
  constexpr uint32_t kPolynomial = 0xedb88320U;
  std::array<uint32_t, 256> table = {};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? kPolynomial : 0U);
    table[byte] = crc;
  }
  return table;
}

constexpr std::array<uint32_t, 256> kTable = make_table();

}  // namespace

void Crc32::add(const unsigned char* bytes, size_t count) {
  uint32_t crc = state_;
  for (size_t i = 0; i < count; ++i) crc = kTable[(crc ^ bytes[i]) & 0xffU] ^ (crc >> 8);
  state_ = crc;
}

}  // namespace unisim
