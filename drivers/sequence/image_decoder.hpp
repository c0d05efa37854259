// SPDX-License-Identifier: MIT
// Decodes image files one after the other into the same memory.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/image.h"

namespace unisim::sequence {

/// Remembers the size of the first good image: every later one must have it.
class SizeCheck {
 public:
  /// @param[out] message set when the size differs @return true if it fits
  bool fits(const cv::Mat& image, std::string* message);

 private:
  cv::Size size_;
};

/// Borrowed view of an 8-bit image with one or three channels.
unisim_image view_of(const cv::Mat& image);

class ImageDecoder {
 public:
  /// Decodes a file: colour as BGR8, gray as GRAY8.
  /// @param[out] image   valid until the next call
  /// @param[out] message what is wrong with the file
  /// @return false when it is missing, empty, truncated, not an image or of another size
  bool decode(const std::string& path, unisim_image* image, std::string* message);

 private:
  bool read_file(const std::string& path, std::string* message);
  bool decode_buffer();

  std::vector<uint8_t> file_;
  cv::Mat image_;
  SizeCheck size_;
};

}  // namespace unisim::sequence
