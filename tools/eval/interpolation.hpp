// SPDX-License-Identifier: MIT
// Poses of a trajectory at times it was not given at.
#pragma once

#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

/// Poses of `trajectory` at the times of `asked`: straight lines and even turns between neighbours
/// no more than max_gap_s apart. Times that lie in no such gap are left out. O(n + m).
Trajectory interpolate(const Trajectory& trajectory, const Trajectory& asked, double max_gap_s);

/// Median of the steps in time, 0 for fewer than two poses.
double median_step_s(const Trajectory& trajectory);

}  // namespace unisim::eval
