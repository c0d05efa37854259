// SPDX-License-Identifier: MIT
// A view of the rendered room as the predictor's steps take it.
#pragma once

#include "drivers/geometric/image/prepared_image.hpp"
#include "tests/geometric/rendered_room.hpp"

namespace unisim::geometric::test {

inline void prepare_view(const CameraPlace& place, PreparedImage* out) {
  ImagePreparation preparation;
  const GrayImage pixels = render_room(place);
  unisim_image image{};
  image.data = pixels.data();
  image.width = kWidth;
  image.height = kHeight;
  image.stride = kWidth;
  image.format = UNISIM_PIXEL_GRAY8;
  preparation.run(image, out);
}

}  // namespace unisim::geometric::test
