// SPDX-License-Identifier: MIT
// Bytes in memory behind the callbacks that save and load maps.
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/mapfile/sections.hpp"

namespace unisim::mapfile {

/// A unisim_map_write onto the end of the Bytes at `context`.
int32_t append_bytes(void* context, const void* bytes, size_t size);

/// What is left of bytes that are given out from the front.
struct ByteSource {
  const Bytes& bytes;
  size_t at = 0;
};

/// A unisim_map_read from the ByteSource at `context`.
int32_t take_bytes(void* context, void* bytes, size_t size);

}  // namespace unisim::mapfile
