// SPDX-License-Identifier: MIT
// Trajectories seen from above, both axes in the same scale.
#pragma once

#include <string>
#include <vector>

#include "tools/replay/report/report.hpp"

namespace unisim::report {

/// The axis looked along: the one with the least motion, of the truth where there is one.
/// @return 0 x, 1 y, 2 z
int view_axis(const ReportData& data);

/// The view as an SVG element.
std::string draw_top_view(const ReportData& data);

}  // namespace unisim::report
