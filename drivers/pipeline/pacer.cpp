// SPDX-License-Identifier: MIT
// Holds a recorded sequence to the times it was recorded at.
#include "drivers/pipeline/pacer.hpp"

#include <algorithm>
#include <limits>
#include <thread>

namespace unisim::pipeline {
namespace {

// A stop is noticed after at most this long: shorter than people call a delay.
constexpr int64_t kSliceNs = 20 * 1000 * 1000;

/// a - b, at the end of the range where it does not fit: recorded times may be anything.
int64_t difference(int64_t a, int64_t b) {
  int64_t result = 0;
  if (!__builtin_sub_overflow(a, b, &result)) return result;
  return a > b ? std::numeric_limits<int64_t>::max() : std::numeric_limits<int64_t>::min();
}

}  // namespace

int64_t Pacer::elapsed_ns() const {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
}

bool Pacer::keep(int64_t timestamp_ns, const std::atomic<bool>* stop) {
  if (!started_) {
    started_ = true;
    start_ = Clock::now();
    first_timestamp_ns_ = last_timestamp_ns_ = timestamp_ns;
    return true;
  }
  const int64_t interval = difference(timestamp_ns, last_timestamp_ns_);
  const int64_t due = difference(timestamp_ns, first_timestamp_ns_);
  last_timestamp_ns_ = timestamp_ns;
  if (difference(elapsed_ns(), due) > interval) return false;
  for (;;) {
    const int64_t early = difference(due, elapsed_ns());
    if (early <= 0 || (stop != nullptr && stop->load())) return true;
    std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(early, kSliceNs)));
  }
}

}  // namespace unisim::pipeline
