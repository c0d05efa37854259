// SPDX-License-Identifier: MIT
// Copies of borrowed images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "drivers/image.h"

namespace unisim::drivers {

/// Copies the pixels of `image`, row beside row, into `pixels`, whose memory is used again.
/// @return the image in `pixels`
inline unisim_image packed_copy(unisim_image image, std::vector<uint8_t>* pixels) {
  const size_t row = static_cast<size_t>(image.width) * static_cast<size_t>(image.format);
  pixels->resize(row * static_cast<size_t>(image.height));
  for (int32_t y = 0; y < image.height; ++y) {
    const size_t line = static_cast<size_t>(y);
    std::memcpy(pixels->data() + line * row, image.data + line * static_cast<size_t>(image.stride),
                row);
  }
  image.data = pixels->data();
  image.stride = static_cast<int32_t>(row);
  return image;
}

}  // namespace unisim::drivers
