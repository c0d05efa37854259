// SPDX-License-Identifier: MIT
// What of a run goes on report.html.
#pragma once

#include <string>
#include <vector>

#include "tools/replay/report/report.hpp"
#include "tools/replay/summary.hpp"

namespace unisim::replay {

/// @param messages lines told during the run
report::ReportData page_data(const Run& run, const std::vector<std::string>& messages);

}  // namespace unisim::replay
