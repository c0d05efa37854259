// SPDX-License-Identifier: MIT
// Decoding of MJPG frames; built with OpenCV or, without it, not at all.
#pragma once

#include <cstddef>
#include <cstdint>

namespace unisim::v4l2 {

class JpegDecoder {
 public:
  /// false: decode() never succeeds, MJPG is not asked for
  static bool built_in();

  /// Gray pixels of one whole JPEG image (jpeg_extent.hpp), into memory the caller has already.
  /// @param gray width x height bytes without gaps
  /// @return false: damaged, or not of this size
  static bool decode(const uint8_t* bytes, size_t size, int32_t width, int32_t height,
                     uint8_t* gray);
};

}  // namespace unisim::v4l2
