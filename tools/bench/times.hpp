// SPDX-License-Identifier: MIT
// Times of many calls in a few numbers, and how results are printed.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

namespace unisim::bench {

using Json = nlohmann::ordered_json;

/// n, p50, p95, max [ms], to the microsecond; all 0 without times.
Json times_json(std::vector<double> times);

/// One line of JSON, or a line per field.
void print_result(const Json& result, bool json);

}  // namespace unisim::bench
