// SPDX-License-Identifier: MIT
// What became of each old keyframe that was looked at for a loop.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/predictor.h"

namespace unisim::pipeline {

/// The newest thousand, and counts of all.
class LoopReports {
 public:
  LoopReports();

  void add(const unisim_place_report& report);
  /// The verdict on a comparison told before. @param reason static text
  void decide(int32_t keyframe, int32_t candidate, bool accepted, const char* reason);
  /// A loop went into the map.
  void count_loop() { ++loops_; }
  /// Fills the fields on places and loops.
  void info(unisim_predictor_info* out) const;

 private:
  std::vector<unisim_place_report> reports_;
  int32_t tried_ = 0;
  int32_t loops_ = 0;
};

}  // namespace unisim::pipeline
