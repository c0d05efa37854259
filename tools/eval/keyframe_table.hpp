// SPDX-License-Identifier: MIT
// The keyframe table of unisim-replay, as far as its poses are to be judged.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

/// What a run says of one keyframe.
struct KeyframeClaim {
  double time_s = 0;
  int64_t segment = -1;
  int64_t confidence = 0;      ///< 0 held, 1 pair only, 2 in a window, 3 in two or a loop
  bool good = false;           ///< state "tracking" or "relocalised"
  double position_sigma = -1;  ///< unit of the trajectory; below 0: not known
  double rotation_sigma = -1;  ///< rad
};

/// Reads keyframes.csv; the columns may stand in any order.
/// @throws InputError
std::vector<KeyframeClaim> read_keyframe_table(const std::string& path);

}  // namespace unisim::eval
