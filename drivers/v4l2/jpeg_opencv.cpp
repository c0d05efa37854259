// SPDX-License-Identifier: MIT
// MJPG by OpenCV's decoder, straight into gray.
#include <opencv2/imgcodecs.hpp>

#include "drivers/v4l2/jpeg_decoder.hpp"

namespace unisim::v4l2 {

bool JpegDecoder::built_in() { return true; }

bool JpegDecoder::decode(const uint8_t* bytes, size_t size, int32_t width, int32_t height,
                         uint8_t* gray) {
  // OpenCV only reads what is behind this pointer, but has no type that says so.
  const cv::Mat data(1, static_cast<int>(size), CV_8UC1, const_cast<uint8_t*>(bytes));
  cv::Mat image(height, width, CV_8UC1, gray);
  try {
    cv::imdecode(data, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION, &image);
  } catch (const cv::Exception&) {
    return false;
  }
  // An image of another size would have been put elsewhere.
  return image.data == gray && image.rows == height && image.cols == width;
}

}  // namespace unisim::v4l2
