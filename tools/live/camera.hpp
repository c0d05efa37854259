// SPDX-License-Identifier: MIT
// The camera of a live run as a source whose stamps are times of day.
#pragma once

#include <cstdint>

#include "tools/live/options.hpp"
#include "tools/replay/run.hpp"

namespace unisim::live {

/// Time of day minus CLOCK_MONOTONIC, nanoseconds, now.
int64_t time_of_day_offset_ns();

/// Opens the camera. Its stamps become those of the time of day by one difference, taken now, so
/// that messages and files can be put beside those of other programs and still never step.
/// Throws Failure: no camera (3), not allowed or busy (4), a wrong option (2).
/// @param[out] stamp_clock_offset_ns stamps minus CLOCK_MONOTONIC
replay::Input open_camera(const Options& options, int64_t* stamp_clock_offset_ns);

/// Frames that were lost on the way here, and why, "" when none were.
/// @param source of open_camera()
std::string camera_losses(const unisim_source* source);

/// The cameras of this machine, for people.
std::string camera_table();

}  // namespace unisim::live
