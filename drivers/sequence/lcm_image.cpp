// SPDX-License-Identifier: MIT
// Images as LCM carries them: bot_core.image_t.
#include "drivers/sequence/lcm_image.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/common/size_text.hpp"

namespace unisim::sequence {
namespace {

// Follows from names, types and dimensions of the fields (tests/lcm/messages_test.cpp).
constexpr uint64_t kFingerprint = 0x14739ffe13d5f5f0ULL;
// Fingerprint, time, five numbers of 32 bits and the size.
constexpr size_t kFixedBytes = 36;
constexpr int32_t kMostPixels = 1 << 26;

constexpr int32_t fourcc(char a, char b, char c, char d) {
  return a | (b << 8) | (c << 16) | (d << 24);
}
constexpr int32_t kGray = fourcc('G', 'R', 'E', 'Y');
constexpr int32_t kRgb = fourcc('R', 'G', 'B', '3');
constexpr int32_t kBgr = fourcc('B', 'G', 'R', '3');
constexpr int32_t kYuyv = fourcc('Y', 'U', 'Y', 'V');
constexpr int32_t kMjpeg = fourcc('M', 'J', 'P', 'G');

/// Of the formats that are not compressed; 0 for others.
int32_t bytes_per_pixel(int32_t pixelformat) {
  if (pixelformat == kGray) return 1;
  if (pixelformat == kYuyv) return 2;
  return pixelformat == kRgb || pixelformat == kBgr ? 3 : 0;
}

int32_t read_int(const uint8_t* bytes) { return static_cast<int32_t>(read_big_endian(bytes, 4)); }

/// Rows as they lie in the message.
bool rows_of(const ImageMessage& message, int32_t pixel, cv::Mat* rows, std::string* reason) {
  const int64_t row = static_cast<int64_t>(message.width) * pixel;
  const int64_t stride = message.row_stride > 0 ? message.row_stride : row;
  const int64_t needed = stride * (message.height - 1) + row;
  if (stride < row || needed > static_cast<int64_t>(message.size)) {
    *reason = "has " + std::to_string(message.size) + " bytes for " +
              drivers::size_text(message.width, message.height) + " pixels in rows of " +
              std::to_string(stride);
    return false;
  }
  // OpenCV reads and does not write.
  *rows = cv::Mat(message.height, message.width, CV_8UC(pixel), const_cast<uint8_t*>(message.data),
                  static_cast<size_t>(stride));
  return true;
}

}  // namespace

uint64_t read_big_endian(const uint8_t* bytes, size_t count) {
  uint64_t value = 0;
  for (size_t k = 0; k < count; ++k) value = (value << 8) | bytes[k];
  return value;
}

bool is_image_message(const uint8_t* bytes, size_t size) {
  return size >= kImageHeadBytes && read_big_endian(bytes, 8) == kFingerprint;
}

int64_t image_utime(const uint8_t* bytes) {
  return static_cast<int64_t>(read_big_endian(bytes + 8, 8));
}

bool parse_image_message(const uint8_t* bytes, size_t size, ImageMessage* image,
                         std::string* reason) {
  if (!is_image_message(bytes, size)) {
    *reason = "is no image_t (its fingerprint is another)";
    return false;
  }
  if (size < kFixedBytes) {
    *reason = "is cut off";
    return false;
  }
  image->utime = image_utime(bytes);
  image->width = read_int(bytes + 16);
  image->height = read_int(bytes + 20);
  image->row_stride = read_int(bytes + 24);
  image->pixelformat = read_int(bytes + 28);
  const int32_t data = read_int(bytes + 32);
  image->data = bytes + kFixedBytes;
  image->size = data > 0 ? static_cast<size_t>(data) : 0;
  if (data < 0 || image->size > size - kFixedBytes) {
    *reason = "is cut off: it says " + std::to_string(data) + " bytes of pixels and has " +
              std::to_string(size - kFixedBytes);
    return false;
  }
  if (image->width <= 0 || image->height <= 0 || image->width > kMostPixels / image->height) {
    *reason = "says it is " + drivers::size_text(image->width, image->height) + " pixels";
    return false;
  }
  return true;
}

bool MessageDecoder::decode_jpeg(const ImageMessage& message, cv::Mat* picture,
                                 std::string* reason) {
  file_.assign(message.data, message.data + message.size);
  if (is_truncated(file_)) {
    *reason = "is a truncated JPEG";
    return false;
  }
  try {
    cv::imdecode(file_, cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION, &converted_);
    *picture = converted_;
  } catch (const cv::Exception&) {
    picture->release();
  }
  const bool good = !picture->empty() && picture->cols == message.width &&
                    picture->rows == message.height && file_[0] == 0xFF;
  if (!good) *reason = "is no JPEG of the size it says";
  return good;
}

bool MessageDecoder::decode(const ImageMessage& message, unisim_image* image, std::string* reason) {
  cv::Mat picture;
  const int32_t pixel = bytes_per_pixel(message.pixelformat);
  if (message.pixelformat == kMjpeg && message.size > 0) {
    if (!decode_jpeg(message, &picture, reason)) return false;
  } else if (pixel == 0) {
    *reason = "has pixelformat " + std::to_string(message.pixelformat) +
              ", which is not read; send GRAY, RGB, BGR, YUYV or MJPEG";
    return false;
  } else if (!rows_of(message, pixel, &picture, reason)) {
    return false;
  }
  if (message.pixelformat == kYuyv && message.width % 2 != 0) {
    *reason = "is YUYV with an odd width";
    return false;
  }
  if (message.pixelformat == kRgb || message.pixelformat == kYuyv) {
    const int code = message.pixelformat == kRgb ? cv::COLOR_RGB2BGR : cv::COLOR_YUV2BGR_YUYV;
    cv::cvtColor(picture, converted_, code);
    picture = converted_;
  }
  if (!size_.fits(picture, reason)) return false;
  *image = view_of(picture);
  return true;
}

}  // namespace unisim::sequence
