// SPDX-License-Identifier: MIT
// Lists of images with their times, in the spellings that recorders and spreadsheets give them.
#pragma once

#include <string>
#include <vector>

#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/time_text.hpp"

namespace unisim::sequence {

/// An image and its time as a list or a file name spells it.
struct TimedName {
  std::string time;
  std::string path;
};

/// Reads "time name", or "time name time name" with colour and depth in either order, into the
/// frames of a recording. Between fields may be blanks, commas and semicolons; names may be quoted
/// or hold blanks; columns after the names are passed over.
/// @param own     unit of the format, kept where the times can be in it
/// @param folders where names are looked for, the usual place first
/// @throws InputError when no line, or less than half of them, can be understood
void read_frame_list(const std::string& path, TimeUnit own, const std::vector<std::string>& folders,
                     Recording* recording);

/// Appends images; the unit is found from all times together. The times must be numbers.
void add_timed_images(const std::vector<TimedName>& images, TimeUnit own, Recording* recording);

}  // namespace unisim::sequence
