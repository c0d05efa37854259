// SPDX-License-Identifier: MIT
// Decodes image files one after the other into the same memory.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/image.h"
#include "drivers/sequence/pixel_rule.hpp"

namespace unisim::sequence {

/// Remembers the size of the first good image: every later one must have it.
class SizeCheck {
 public:
  /// @param[out] message set when the size differs @return true if it fits
  bool fits(const cv::Mat& image, std::string* message);

 private:
  cv::Size size_;
};

/// Whether a JPEG or PNG has no end: decoders fill what is missing with gray.
bool is_truncated(const std::vector<uint8_t>& file);

/// Borrowed view of an 8-bit image with one or three channels.
unisim_image view_of(const cv::Mat& image);

/// An image file as it is stored: not turned, 8 or 16 bits, one or three channels.
class StoredImage {
 public:
  /// @param[out] message what is wrong with the file; may be NULL
  /// @return false when it is missing, empty, truncated or not an image
  bool read(const std::string& path, std::string* message = nullptr);

  /// The same with 16 bits reduced to 8 as the decoder of the format does it.
  bool read_8_bits(const std::string& path, std::string* message);

  const cv::Mat& pixels() const { return pixels_; }
  int orientation() const { return orientation_; }

 private:
  bool load(const std::string& path, std::string* message);
  bool decode(const std::string& path, int flags, std::string* message);

  std::vector<uint8_t> file_;
  cv::Mat pixels_;
  int orientation_ = 1;
};

class ImageDecoder {
 public:
  explicit ImageDecoder(const PixelRule& rule) : rule_(rule) {}

  const PixelRule& rule() const { return rule_; }

  /// Decodes a file: colour as BGR8, gray as GRAY8.
  /// @param[out] image   valid until the next call
  /// @param[out] message what is wrong with the file
  /// @return false when it is missing, empty, truncated, not an image or of another size
  bool decode(const std::string& path, unisim_image* image, std::string* message);

 private:
  PixelRule rule_;
  StoredImage stored_;
  cv::Mat reduced_;
  cv::Mat turned_;
  SizeCheck size_;
};

}  // namespace unisim::sequence
