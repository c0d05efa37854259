// SPDX-License-Identifier: MIT
// CRC-32C (Castagnoli, reflected polynomial 0x82f63b78), as in iSCSI and ext4.
#pragma once

#include <cstddef>
#include <cstdint>

namespace unisim::recorded {

/// CRC-32C of `size` bytes; `crc` is the result for the bytes before them, 0 at the start.
std::uint32_t crc32c(const void* data, std::size_t size, std::uint32_t crc = 0);

}  // namespace unisim::recorded
