// SPDX-License-Identifier: MIT
// Time stamps as text and in seconds.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/common/format.hpp"

namespace unisim::drivers {

/// Seconds with all nine decimals, which a double does not hold for dates: "1305031102.175304001".
inline std::string stamp_text(int64_t time_ns) {
  constexpr uint64_t kSecond = 1000000000;
  const bool negative = time_ns < 0;
  const uint64_t size =
      negative ? 0 - static_cast<uint64_t>(time_ns) : static_cast<uint64_t>(time_ns);
  return format("%s%llu.%09llu", negative ? "-" : "",
                static_cast<unsigned long long>(size / kSecond),
                static_cast<unsigned long long>(size % kSecond));
}

/// The double nearest to it: in seconds, as a list of times has it.
inline double stamp_seconds(int64_t time_ns) {
  constexpr int64_t kSecond = 1000000000;
  return static_cast<double>(time_ns / kSecond) +
         static_cast<double>(time_ns % kSecond) / static_cast<double>(kSecond);
}

}  // namespace unisim::drivers
