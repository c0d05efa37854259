// SPDX-License-Identifier: MIT
// Where a JPEG image in a buffer ends, and how large it is, without decoding it.
#include "drivers/v4l2/jpeg_extent.hpp"

#include <cstring>

namespace unisim::v4l2 {
namespace {

constexpr uint8_t kStart = 0xd8;
constexpr uint8_t kEnd = 0xd9;
constexpr uint8_t kScan = 0xda;

int32_t big_endian(const uint8_t* bytes) { return bytes[0] * 256 + bytes[1]; }

// Marks of a frame's size: all of 0xc0..0xcf but three that share the range.
bool is_frame(uint8_t mark) {
  return mark >= 0xc0 && mark <= 0xcf && mark != 0xc4 && mark != 0xc8 && mark != 0xcc;
}

// Marks that belong to the compressed data: a stuffed 0xff, restarts, fill bytes.
bool is_data(uint8_t mark) {
  return mark == 0 || mark == 1 || mark == 0xff || (mark >= 0xd0 && mark <= 0xd7);
}

// Position of the next mark's 0xff at or after `at`, `size` if there is none.
size_t skip_data(const uint8_t* bytes, size_t size, size_t at) {
  while (at + 1 < size) {
    const void* found = std::memchr(bytes + at, 0xff, size - 1 - at);
    if (found == nullptr) return size;
    at = static_cast<size_t>(static_cast<const uint8_t*>(found) - bytes);
    if (!is_data(bytes[at + 1])) return at;
    ++at;
  }
  return size;
}

}  // namespace

JpegExtent jpeg_extent(const uint8_t* bytes, size_t size) {
  JpegExtent extent;
  if (size < 4 || bytes[0] != 0xff || bytes[1] != kStart) return extent;
  size_t at = 2;
  bool any_scan = false;
  while (at + 1 < size) {
    if (bytes[at] != 0xff) return extent;
    const uint8_t mark = bytes[at + 1];
    if (mark == 0xff) {
      ++at;
      continue;
    }
    if (mark == kEnd) {
      if (any_scan) extent.bytes = at + 2;
      return extent;
    }
    if (at + 3 >= size) return extent;
    const auto length = static_cast<size_t>(big_endian(bytes + at + 2));
    if (length < 2) return extent;
    if (is_frame(mark) && length >= 8 && at + 9 <= size) {
      extent.height = big_endian(bytes + at + 5);
      extent.width = big_endian(bytes + at + 7);
    }
    at += 2 + length;
    if (mark == kScan) {
      any_scan = true;
      at = skip_data(bytes, size, at);
    }
  }
  return extent;
}

}  // namespace unisim::v4l2
