// SPDX-License-Identifier: MIT
// The image of --mask.
#include "tools/replay/mask.hpp"

#include <algorithm>

#include "drivers/common/size_text.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/inputs.hpp"

namespace unisim::replay {
namespace {

tools::Failure bad_mask(const Options& options, const std::string& what) {
  return {tools::kExitInput, options.mask + ": " + what};
}

void check_size(const Options& options, const unisim_image& mask) {
  const auto size = frame_size(options);
  if (!size || (size->width == mask.width && size->height == mask.height)) return;
  throw bad_mask(options, "the mask has " + drivers::size_text(mask.width, mask.height) +
                              " pixels, the frames " +
                              drivers::size_text(size->width, size->height) +
                              "; give a mask of their size");
}

}  // namespace

Mask load_mask(const Options& options) {
  Mask mask;
  if (options.mask.empty()) return mask;
  Options of_mask = options;
  of_mask.from = 0;
  of_mask.to = -1;
  of_mask.sequence = options.mask;
  of_mask.format = "images";
  std::vector<std::string> notes;
  const SourcePtr source = open_sequence(of_mask, &notes);
  unisim_frame frame{};
  if (source->next_frame(source.get(), 1, &frame) != UNISIM_FRAME_OK) {
    throw tools::Failure(tools::kExitInput, source->message(source.get()));
  }
  const unisim_image& image = frame.image;
  for (int32_t y = 0; y < image.height; ++y) {
    const uint8_t* row = image.data + int64_t{y} * image.stride;
    for (int32_t x = 0; x < image.width; ++x) {
      mask.pixels.push_back(
          *std::max_element(row + x * image.format, row + (x + 1) * image.format));
    }
  }
  const int brightest = *std::max_element(mask.pixels.begin(), mask.pixels.end());
  if (brightest == 0) throw bad_mask(options, "all black: nothing would be looked at");
  for (uint8_t& value : mask.pixels) value = 2 * value < brightest ? 0 : 255;
  mask.view = {mask.pixels.data(), image.width, image.height, image.width, UNISIM_PIXEL_GRAY8};
  check_size(options, mask.view);
  return mask;
}

}  // namespace unisim::replay
