// SPDX-License-Identifier: MIT
// Event logs with images, and what is read from them.
#include "tests/lcm/image_log.hpp"

#include "tests/lcm/event_log.hpp"
#include "tests/support/catch.hpp"
#include "unisim_image_t.h"

namespace unisim::testing {

std::string image_message(int64_t utime, int32_t width, int32_t height, int32_t row_stride,
                          int32_t pixelformat, const std::string& data) {
  std::string pixels = data;
  unisim_image_t image{};
  image.utime = utime;
  image.width = width;
  image.height = height;
  image.row_stride = row_stride;
  image.pixelformat = pixelformat;
  image.size = static_cast<int32_t>(pixels.size());
  image.data = reinterpret_cast<uint8_t*>(pixels.data());
  std::string bytes(static_cast<size_t>(unisim_image_t_encoded_size(&image)), '\0');
  const int size = static_cast<int>(bytes.size());
  REQUIRE(unisim_image_t_encode(bytes.data(), 0, size, &image) == size);
  return bytes;
}

std::string gray_message(int64_t utime, int brightness, int32_t width, int32_t height) {
  return image_message(
      utime, width, height, width, UNISIM_IMAGE_T_PIXEL_FORMAT_GRAY,
      std::string(static_cast<size_t>(width * height), static_cast<char>(brightness)));
}

std::string gray_log(int count, const std::string& channel) {
  std::string log;
  for (int k = 0; k < count; ++k) {
    const int64_t utime = 1000000 + 100000 * k;
    log += event_bytes(k, utime + 5, channel, gray_message(utime, 10 + k));
  }
  return log;
}

Played play_log(const std::string& path, const char* channel) {
  unisim_sequence_options options{};
  options.struct_size = sizeof options;
  options.format = "lcm";
  options.channel = channel;
  Played played;
  char message[1024] = "";
  const LogSource source(unisim_sequence_open(path.c_str(), &options, message, sizeof message));
  played.failure = message;
  if (source == nullptr) return played;
  for (int32_t i = 0; unisim_sequence_note(source.get(), i) != nullptr; ++i) {
    played.notes += std::string(unisim_sequence_note(source.get(), i)) + "\n";
  }
  for (;;) {
    unisim_frame frame{};
    const int status = source->next_frame(source.get(), 1, &frame);
    if (status == UNISIM_FRAME_END) return played;
    REQUIRE(status != UNISIM_FRAME_FAILED);
    if (status == UNISIM_FRAME_BAD) {
      played.bad.emplace_back(source->message(source.get()));
      continue;
    }
    const unisim_image& image = frame.image;
    const uint8_t* middle =
        image.data + (image.height / 2) * image.stride + (image.width / 2) * image.format;
    const int last = image.format == UNISIM_PIXEL_GRAY8 ? 0 : 1;
    played.first_bytes.push_back(image.data[0]);
    played.middle.emplace_back(middle[0], middle[last], middle[2 * last]);
    played.times_ns.push_back(frame.timestamp_ns);
  }
}

}  // namespace unisim::testing
