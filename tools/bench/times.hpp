// SPDX-License-Identifier: MIT
// Times of many calls in a few numbers, and how results are printed.
#pragma once

#include <vector>

#include "tools/common/json_text.hpp"

namespace unisim::bench {

using tools::Json;

/// n, p50, p95, max [ms], to the microsecond; all 0 without times.
Json times_json(std::vector<double> times);

/// One line of JSON, or a line per field.
void print_result(const Json& result, bool json);

}  // namespace unisim::bench
