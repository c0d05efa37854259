// SPDX-License-Identifier: MIT
// Images that say how they are to be turned, as cameras and phones write them.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "tests/support/temp_folder.hpp"

/// 48x32, bright in the upper left quarter.
cv::Mat corner_image();

/// Writes corner_image() with an EXIF orientation tag.
/// @param name        its ending says the format: jpg, png, webp or tif
/// @param orientation 1 to 8; 0: without the tag
void write_tagged_image(const TempFolder& folder, const std::string& name, int orientation);
