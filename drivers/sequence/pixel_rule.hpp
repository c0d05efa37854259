// SPDX-License-Identifier: MIT
// How the images of a sequence become 8-bit pictures: decided once, the same for each of them.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace unisim::sequence {

/// A camera does not turn its sensor or change its bits on the way: what a single file says counts
/// for nothing.
struct PixelRule {
  int orientation = 1;  ///< EXIF, 1 to 8: that of the first image that can be read
  int bits = 16;        ///< used of 16-bit pixels: 8, 10, 12, 14 or 16
  cv::Size stretched;   ///< of a video's pictures; empty: as they are stored
};

/// Whole bits that hold `brightest` in steps of cameras: 8, 10, 12, 14 or 16.
int bits_that_hold(int brightest);

/// Turns a picture upright. @param[out] turned set unless orientation is 1
/// @return the upright one of the two
cv::Mat upright(const cv::Mat& image, int orientation, cv::Mat* turned);

/// 16-bit pixels to 8 bits; what is beyond `bits` is white.
void reduce_to_8_bits(const cv::Mat& deep, int bits, cv::Mat* image);

/// The rule for the images at `paths`; missing and damaged ones are passed over.
/// @throws InputError when they are depth maps
PixelRule learn_pixel_rule(const std::vector<std::string>& paths);

/// What a user should know of it, "" if nothing.
std::string pixel_note(const PixelRule& rule);

}  // namespace unisim::sequence
