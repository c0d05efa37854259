// SPDX-License-Identifier: MIT
// Images as LCM carries them: bot_core.image_t, read with bounds that hold for any bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/image.h"
#include "drivers/sequence/image_decoder.hpp"

namespace unisim::sequence {

/// Borrows the bytes it was read from.
struct ImageMessage {
  int64_t utime;  ///< microseconds
  int32_t width;
  int32_t height;
  int32_t row_stride;
  int32_t pixelformat;
  const uint8_t* data;
  size_t size;
};

/// Bytes in which fingerprint and time lie, at the front of a message.
constexpr size_t kImageHeadBytes = 16;

/// Whether a message says it is an image_t. @param bytes kImageHeadBytes or more
bool is_image_message(const uint8_t* bytes, size_t size);
/// @param bytes kImageHeadBytes or more
int64_t image_utime(const uint8_t* bytes);

/// @param[out] reason why it cannot be one, when false is returned
bool parse_image_message(const uint8_t* bytes, size_t size, ImageMessage* image,
                         std::string* reason);

/// Most significant byte first.
uint64_t read_big_endian(const uint8_t* bytes, size_t count);

/// Decodes one after the other into the same memory. GRAY and MJPEG in gray become GRAY8, all else
/// BGR8.
class MessageDecoder {
 public:
  /// @param[out] image valid until the next call, or until the message is gone
  /// @param[out] reason what is wrong with it, when false is returned
  bool decode(const ImageMessage& message, unisim_image* image, std::string* reason);

 private:
  bool decode_jpeg(const ImageMessage& message, cv::Mat* picture, std::string* reason);

  cv::Mat converted_;
  std::vector<uint8_t> file_;
  SizeCheck size_;
};

}  // namespace unisim::sequence
