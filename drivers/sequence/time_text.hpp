// SPDX-License-Identifier: MIT
// Times as text: exact to the nanosecond, in the unit that a whole list is found to be written in.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace unisim::sequence {

/// Each a thousandth of the one before.
enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// "seconds" and so on.
const char* unit_name(TimeUnit unit);

double units_per_second(TimeUnit unit);

/// A decimal number with or without exponent, to the nearest nanosecond.
/// @return false if it is not one or out of range
bool parse_time(std::string_view text, TimeUnit unit, int64_t* ns);

/// Unit of a list of times, by its steps and its largest value; dates are seconds since 1970.
/// @param own                unit of the format: kept where it is possible
/// @param longest_own_step_s usual step, in seconds, up to which the format's unit is possible
TimeUnit guess_unit(std::vector<double> times, TimeUnit own, double longest_own_step_s);

/// Longest usual step of a list of images, and of a list of poses, which may be numbered instead.
constexpr double kLongestImageStepS = 5.0;
constexpr double kLongestPoseStepS = 1000.0;

/// True for seconds since 1970 that a recording can have: 2001 to 2100.
bool is_date(double seconds);

}  // namespace unisim::sequence
