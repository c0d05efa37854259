// SPDX-License-Identifier: MIT
// Summary of a list of errors.
#pragma once

#include <cstddef>
#include <vector>

namespace unisim::eval {

/// All zero for no values. The standard deviation is that of the population.
struct Statistics {
  size_t count = 0;
  double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0, sse = 0;
};

Statistics summarise(std::vector<double> values);

}  // namespace unisim::eval
