// SPDX-License-Identifier: MIT
// What went wrong with a device, in one line: what, where, what to do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace unisim::v4l2 {

/// Opening, or opening again, did not work.
class DeviceError : public std::runtime_error {
 public:
  DeviceError(int problem, int error, const std::string& text)
      : std::runtime_error(text), problem_(problem), error_(error) {}

  int problem() const { return problem_; }  ///< UNISIM_V4L2_*
  int error() const { return error_; }      ///< errno, 0 where no call failed

 private:
  int problem_;
  int error_;
};

/// @param error errno, positive
bool means_unplugged(int error);

/// What a person can do about it. @param error errno, positive
const char* advice(int error);

/// Writes the line about a call that failed, without the heap.
void describe(const char* device, const char* call, int error, char* text, size_t capacity);

/// The same as an exception.
DeviceError call_failed(const std::string& device, const char* call, int error);

/// "YUYV" of the four characters in a number.
std::string fourcc_text(uint32_t fourcc);

/// "30", "29.97"
std::string rate_text(double fps);

}  // namespace unisim::v4l2
