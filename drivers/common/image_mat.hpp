// SPDX-License-Identifier: MIT
// An image as OpenCV sees it.
#pragma once

#include <opencv2/core/mat.hpp>

#include "drivers/image.h"

namespace unisim::drivers {

/// The image's own pixels, which are only to be read: cv::Mat has no read-only view.
inline cv::Mat image_mat(const unisim_image& image) {
  const int type = image.format == UNISIM_PIXEL_BGR8 ? CV_8UC3 : CV_8UC1;
  return {image.height, image.width, type, const_cast<uint8_t*>(image.data),
          static_cast<size_t>(image.stride)};
}

}  // namespace unisim::drivers
