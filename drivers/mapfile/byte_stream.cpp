// SPDX-License-Identifier: MIT
// Bytes in memory behind the callbacks that save and load maps.
#include "drivers/mapfile/byte_stream.hpp"

#include <cstring>

namespace unisim::mapfile {

int32_t append_bytes(void* context, const void* bytes, size_t size) {
  const auto* from = static_cast<const uint8_t*>(bytes);
  auto* to = static_cast<Bytes*>(context);
  to->insert(to->end(), from, from + size);
  return 1;
}

int32_t take_bytes(void* context, void* bytes, size_t size) {
  auto* from = static_cast<ByteSource*>(context);
  if (size > from->bytes.size() - from->at) return 0;
  std::memcpy(bytes, from->bytes.data() + from->at, size);
  from->at += size;
  return 1;
}

}  // namespace unisim::mapfile
