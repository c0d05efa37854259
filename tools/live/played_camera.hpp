// SPDX-License-Identifier: MIT
// A recording that plays the camera of a live run.
#pragma once

#include <cstdint>

#include "drivers/common/owned.hpp"

namespace unisim::live {

/// Gives the frames of a recording when they are due, stamped with the time of day at which they
/// were: what a program sees of a camera that sends uncompressed images. Nothing waits for the run:
/// a frame is due whether or not the last one has been taken.
/// @param recording     a sequence
/// @param time_of_day_ns time of day minus CLOCK_MONOTONIC
drivers::SourcePtr play_as_camera(drivers::SourcePtr recording, int64_t time_of_day_ns);

}  // namespace unisim::live
