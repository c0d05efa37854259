// SPDX-License-Identifier: MIT
// What is counted, readable from any thread.
#pragma once

#include <atomic>
#include <cstdint>

namespace unisim::v4l2 {

struct Counters {
  std::atomic<int64_t> frames{0};
  std::atomic<int64_t> lost{0};
  std::atomic<int64_t> superseded{0};
  std::atomic<int64_t> errors{0};
  std::atomic<int64_t> bad{0};
  std::atomic<int64_t> restamped{0};
  std::atomic<int64_t> restarts{0};
  std::atomic<int64_t> reconnects{0};
};

}  // namespace unisim::v4l2
