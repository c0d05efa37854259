// SPDX-License-Identifier: MIT
// Tells when a predictor's focal length is hardly known from what was filmed.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/predictor.h"

namespace unisim::pipeline {

/// One line on what that means and what would help; empty: the focal length is given, is known well
/// enough, or the predictor says nothing of it.
std::string focal_doubt(const unisim_predictor_info& info);

/// When a run that has no end is asked: after a while, and then more and more seldom.
class FocalWatch {
 public:
  /// @param keyframes so far
  bool due(int64_t keyframes) {
    if (keyframes < next_) return false;
    next_ *= kGrowth;
    return true;
  }

 private:
  static constexpr int64_t kFirst = 60;  // the first few never tell it
  static constexpr int64_t kGrowth = 10;

  int64_t next_ = kFirst;
};

}  // namespace unisim::pipeline
