// SPDX-License-Identifier: MIT
// Videos whose pixels are wider than high, or the other way, become pictures of square ones.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "drivers/sequence/pixel_rule.hpp"

namespace unisim::sequence {

/// A camera model of one focal length holds for square pixels only.
class SquarePixels {
 public:
  SquarePixels() = default;

  /// @param stored size of the pictures as they come @param shown what it becomes
  SquarePixels(cv::Size stored, cv::Size shown, const std::string& aspect);

  /// @param[out] stretched set where the pixels are not square @return the picture to use
  const cv::Mat& apply(const cv::Mat& image, cv::Mat* stretched) const;

  PixelRule rule() const { return {1, 16, shown_}; }

  /// What a user should know of it.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  cv::Size shown_;
  std::vector<std::string> notes_;
};

/// As the container says. @throws InputError where that is out of all reason
SquarePixels square_pixels(const std::string& path, const cv::VideoCapture& video);

}  // namespace unisim::sequence
