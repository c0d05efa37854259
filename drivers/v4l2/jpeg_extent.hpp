// SPDX-License-Identifier: MIT
// Where a JPEG image in a buffer ends, and how large it is, without decoding it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace unisim::v4l2 {

struct JpegExtent {
  size_t bytes = 0;  ///< 0: no JPEG, or its end is missing
  int32_t width = 0;
  int32_t height = 0;
};

/// Buffers are longer than the image in them, hold something else at first, or are cut off, which
/// decoders fill up with gray. So the marks are followed from the first to the last.
JpegExtent jpeg_extent(const uint8_t* bytes, size_t size);

}  // namespace unisim::v4l2
