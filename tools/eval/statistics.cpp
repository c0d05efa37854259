// SPDX-License-Identifier: MIT
// Summary of a list of errors.
#include "tools/eval/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::eval {

Statistics summarise(std::vector<double> values) {
  Statistics s;
  s.count = values.size();
  if (values.empty()) return s;
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  for (const double v : values) {
    s.mean += v / n;
    s.sse += v * v;
  }
  double variance = 0;
  for (const double v : values) variance += (v - s.mean) * (v - s.mean) / n;
  const size_t half = values.size() / 2;
  s.median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  s.rmse = std::sqrt(s.sse / n);
  s.std = std::sqrt(variance);
  s.min = values.front();
  s.max = values.back();
  return s;
}

}  // namespace unisim::eval
