// SPDX-License-Identifier: MIT
// Times of many calls in a few numbers.
#include "tools/bench/times.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "drivers/common/format.hpp"
#include "tools/common/output.hpp"

namespace unisim::bench {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size());
  const size_t at = static_cast<size_t>(std::max(0.0, std::ceil(place) - 1.0));
  return std::round(sorted[std::min(at, sorted.size() - 1)] * 1e3) / 1e3;
}

}  // namespace

Json times_json(std::vector<double> times) {
  if (times.empty()) return {{"n", 0}, {"p50", 0}, {"p95", 0}, {"max", 0}};
  std::sort(times.begin(), times.end());
  return {{"n", times.size()},
          {"p50", quantile(times, 0.5)},
          {"p95", quantile(times, 0.95)},
          {"max", quantile(times, 1.0)}};
}

void print_result(const Json& result, bool json) {
  if (json) {
    tools::print(tools::json_text(result) + "\n");
    return;
  }
  std::string text;
  for (const auto& [key, value] : result.items()) {
    text += drivers::format("%-22s %s\n", key.c_str(), tools::json_text(value).c_str());
  }
  tools::print(text);
}

}  // namespace unisim::bench
