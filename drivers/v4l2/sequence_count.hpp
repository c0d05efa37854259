// SPDX-License-Identifier: MIT
// How many frames never came, by the numbers the camera's driver gives to frames.
#pragma once

#include <cstdint>

namespace unisim::v4l2 {

class SequenceCount {
 public:
  /// @param number   the driver's, which wraps around, may repeat and may jump
  /// @param stamp_ns time of the frame
  /// @return frames lost between the one before and this one
  int64_t lost_before(uint32_t number, int64_t stamp_ns, int64_t period_ns);

  /// The next number starts a new count.
  void restart() { any_ = false; }

 private:
  uint32_t last_ = 0;
  int64_t last_ns_ = 0;
  bool any_ = false;
};

}  // namespace unisim::v4l2
