// SPDX-License-Identifier: MIT
// How many frames never came, by the numbers the camera's driver gives to frames.
#include "drivers/v4l2/sequence_count.hpp"

namespace unisim::v4l2 {

int64_t SequenceCount::lost_before(uint32_t number, int64_t stamp_ns, int64_t period_ns) {
  const auto ahead = static_cast<int32_t>(number - last_);  // right across the wrap
  const int64_t elapsed_ns = stamp_ns - last_ns_;
  const bool first = !any_;
  any_ = true;
  last_ = number;
  last_ns_ = stamp_ns;
  if (first || ahead <= 1) return 0;
  // Some drivers begin at 0 and go on with the number of frames since the camera was plugged in. A
  // jump for which the time has not passed is such a new beginning; twice the time allows for
  // stamps that are off by most of a period.
  const int64_t possible = 2 * elapsed_ns / period_ns + 1;
  return ahead - 1 <= possible ? ahead - 1 : 0;
}

}  // namespace unisim::v4l2
