// SPDX-License-Identifier: MIT
// Time stamps of buffers on one clock: CLOCK_MONOTONIC, growing, not ahead of now.
#include "drivers/v4l2/stamp_clock.hpp"

#include <algorithm>

namespace unisim::v4l2 {
namespace {

// A stamp belongs to a clock when it is that near to it. Frames wait for less than this in the few
// buffers of a camera, and the two clocks are apart by more unless the machine was just booted
// in 1970, where it does not matter which is taken.
constexpr int64_t kNear = 10'000'000'000;

bool near(int64_t a, int64_t b) { return a > b - kNear && a < b + kNear; }

}  // namespace

// What the driver says about its clock is not looked at: some leave it open, some are wrong.
bool StampClock::to_monotonic(int64_t raw_ns, Now now, int64_t* monotonic_ns) {
  // Both clocks as of now: a step of the wall clock between two frames cancels out.
  *monotonic_ns =
      near(raw_ns, now.monotonic_ns) ? raw_ns : raw_ns - now.realtime_ns + now.monotonic_ns;
  return near(*monotonic_ns, now.monotonic_ns);
}

StampClock::Stamp StampClock::map(int64_t raw_ns, Now now, int64_t period_ns) {
  Stamp stamp{now.monotonic_ns, true};
  stamp.measured = to_monotonic(raw_ns, now, &stamp.ns);
  // No frame was taken after it had arrived.
  if (!stamp.measured || stamp.ns > now.monotonic_ns) stamp = {now.monotonic_ns, false};
  if (any_ && stamp.ns <= last_ns_) {
    const int64_t next = std::min(last_ns_ + period_ns, now.monotonic_ns);
    stamp = {std::max(next, last_ns_ + 1), false};
  }
  last_ns_ = stamp.ns;
  any_ = true;
  return stamp;
}

}  // namespace unisim::v4l2
