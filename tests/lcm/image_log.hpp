// SPDX-License-Identifier: MIT
// Event logs with images, and what is read from them.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/sequence/sequence.h"

namespace unisim::testing {

/// An image_t message as lcm-gen encodes it.
std::string image_message(int64_t utime, int32_t width, int32_t height, int32_t row_stride,
                          int32_t pixelformat, const std::string& data);

/// One in gray, filled with one brightness.
std::string gray_message(int64_t utime, int brightness, int32_t width = 8, int32_t height = 6);

/// A log of `count` gray images on a channel, brightness 10, 11, ... and 1/10 s apart.
std::string gray_log(int count, const std::string& channel = "UNISIM_IMAGE");

struct DestroySource {
  void operator()(unisim_source* source) const { source->destroy(source); }
};
using LogSource = std::unique_ptr<unisim_source, DestroySource>;

/// What an opened and played log said.
struct Played {
  std::string failure;            ///< of opening, "" if it opened
  std::string notes;              ///< one text
  std::vector<int> first_bytes;   ///< first byte of each good image
  std::vector<cv::Vec3i> middle;  ///< blue green red in the middle of each, gray three times
  std::vector<int64_t> times_ns;  ///< of good images
  std::vector<std::string> bad;   ///< messages of bad frames
};
Played play_log(const std::string& path, const char* channel = nullptr);

}  // namespace unisim::testing
