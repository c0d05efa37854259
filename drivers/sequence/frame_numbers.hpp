// SPDX-License-Identifier: MIT
// The number in the name of an image: it, not the place in the listing, says which frame it is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/sequence/recording.hpp"

namespace unisim::sequence {

/// Numbers of images in natural order whose names differ in one number alone, endings apart.
/// @return one for each name; empty when they differ otherwise
std::vector<int64_t> frame_numbers(const std::vector<std::string>& names);

/// Notes that numbers are missing, where they are.
void note_gaps(const std::vector<int64_t>& numbers, Recording* recording);

/// Line, from 0, that belongs to each image in a list with a line per frame: that of its number.
/// Where the numbers go beyond the list, or there are none, images and lines are paired in order if
/// there are as many of both, which is noted.
/// @param[out] problem why it cannot be told @return empty when it cannot be told
std::vector<int64_t> lines_of_images(const std::vector<std::string>& names, size_t lines,
                                     const std::string& list_path, Recording* recording,
                                     std::string* problem);

/// 0, 1, 2, ...
std::vector<int64_t> positions(size_t count);

}  // namespace unisim::sequence
