// SPDX-License-Identifier: MIT
// Trajectories seen from above.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/eval/ate.hpp"
#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

/// Rows are the horizontal axes of the view in world coordinates. Up is where the cameras' tops
/// point on average; the first axis is that of the largest extent.
Eigen::Matrix<double, 2, 3> top_view_axes(const Trajectory& trajectory);

/// Draws ground truth and aligned estimate as a PNG with a scale bar and the figures.
/// @return false when the file cannot be written
bool write_top_view(const std::string& path, const Trajectory& ground_truth, const Ate& ate);

}  // namespace unisim::eval
