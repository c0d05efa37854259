// SPDX-License-Identifier: MIT
// Time stamps of buffers on one clock: CLOCK_MONOTONIC, growing, not ahead of now.
#pragma once

#include <cstdint>

namespace unisim::v4l2 {

class StampClock {
 public:
  /// The two clocks at the moment a buffer was taken out of the queue.
  struct Now {
    int64_t monotonic_ns;
    int64_t realtime_ns;
  };
  struct Stamp {
    int64_t ns;
    bool measured;  ///< false: the driver's was of no use
  };

  /// The driver's stamp on CLOCK_MONOTONIC. @return false: it is of neither clock
  static bool to_monotonic(int64_t raw_ns, Now now, int64_t* monotonic_ns);

  /// @param raw_ns    the driver's stamp, of whatever clock
  /// @param period_ns time between frames, about
  Stamp map(int64_t raw_ns, Now now, int64_t period_ns);

 private:
  int64_t last_ns_ = 0;
  bool any_ = false;
};

}  // namespace unisim::v4l2
