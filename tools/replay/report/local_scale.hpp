// SPDX-License-Identifier: MIT
// How the scale of a trajectory varies along it.
#pragma once

#include <vector>

#include "tools/replay/report/report.hpp"

namespace unisim::report {

/// Scale of each piece of 2 half + 1 neighbouring poses: spread of the estimate about its mean over
/// the spread of the truth. 1 where the piece is as large as the truth; pieces of two segments or
/// without motion (spread below a thousandth of the whole) are left out.
/// @param estimate aligned positions
/// @param truth    as many, truth[k] at the time of estimate[k]
std::vector<Sample> local_scale(const std::vector<Point>& estimate, const std::vector<Point>& truth,
                                int half = 7);

}  // namespace unisim::report
