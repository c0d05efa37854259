// SPDX-License-Identifier: MIT
// The formats this driver reads, and their gray pixels.
#include "drivers/v4l2/pixel_formats.hpp"

#include <linux/videodev2.h>

#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/jpeg_decoder.hpp"

namespace unisim::v4l2 {

const std::vector<uint32_t>& usable_formats() {
  static const std::vector<uint32_t> formats = [] {
    std::vector<uint32_t> list = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_YUYV};
    if (JpegDecoder::built_in()) list.push_back(V4L2_PIX_FMT_MJPEG);
    return list;
  }();
  return formats;
}

std::string usable_formats_text() {
  std::string text;
  for (const uint32_t fourcc : usable_formats()) {
    text += (text.empty() ? "" : ", ") + fourcc_text(fourcc);
  }
  return text;
}

int32_t row_bytes(uint32_t fourcc, int32_t width) {
  switch (fourcc) {
    case V4L2_PIX_FMT_GREY:
    case V4L2_PIX_FMT_NV12:
      return width;
    case V4L2_PIX_FMT_YUYV:
      return (width + 1) / 2 * 4;
    default:
      return 0;
  }
}

size_t needed_bytes(uint32_t fourcc, int32_t width, int32_t height, int32_t stride) {
  const int32_t row = row_bytes(fourcc, width);
  if (row == 0) return 0;
  return static_cast<size_t>(stride) * static_cast<size_t>(height - 1) + static_cast<size_t>(row);
}

void extract_yuyv_luma(const uint8_t* yuyv, int32_t width, int32_t height, int32_t stride,
                       uint8_t* luma) {
  for (int32_t y = 0; y < height; ++y) {
    const uint8_t* in = yuyv + static_cast<ptrdiff_t>(y) * stride;
    uint8_t* out = luma + static_cast<ptrdiff_t>(y) * width;
    for (ptrdiff_t x = 0; x < width; ++x) out[x] = in[2 * x];
  }
}

}  // namespace unisim::v4l2
