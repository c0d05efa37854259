// SPDX-License-Identifier: MIT
// MJPG in a build without OpenCV: not offered.
#include "drivers/v4l2/jpeg_decoder.hpp"

namespace unisim::v4l2 {

bool JpegDecoder::built_in() { return false; }

bool JpegDecoder::decode(const uint8_t*, size_t, int32_t, int32_t, uint8_t*) { return false; }

}  // namespace unisim::v4l2
