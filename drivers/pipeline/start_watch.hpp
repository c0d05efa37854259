// SPDX-License-Identifier: MIT
// When a run without a start says why: after a few seconds, and then more and more seldom.
#pragma once

#include <cstdint>

namespace unisim::pipeline {

class StartWatch {
 public:
  /// @param frames tracked so far
  bool due(int64_t frames) {
    if (frames < next_) return false;
    next_ *= kGrowth;
    return true;
  }

 private:
  static constexpr int64_t kFirst = 100;  // frames
  static constexpr int64_t kGrowth = 4;

  int64_t next_ = kFirst;
};

}  // namespace unisim::pipeline
