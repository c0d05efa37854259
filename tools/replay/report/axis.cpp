// SPDX-License-Identifier: MIT
// A range of values on a drawing.
#include "tools/replay/report/axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace unisim::report {

double tick_step(double low, double high, int wanted) {
  const double rough = (high - low) / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double ratio = rough / power;
  if (ratio <= 1.0) return power;
  if (ratio <= 2.0) return 2.0 * power;
  return ratio <= 5.0 ? 5.0 * power : 10.0 * power;
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> values;
  const double first = std::ceil(low / step - 1e-9);
  const double last = std::floor(high / step + 1e-9);
  constexpr int kMost = 100;
  const int count = static_cast<int>(std::clamp(last - first + 1.0, 0.0, double{kMost}));
  values.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) values.push_back((first + k) * step);
  return values;
}

void Range::add(double value) {
  if (!std::isfinite(value)) return;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
}

double Range::pad(double margin) const {
  if (margin == 0.0) return 0.0;
  const double size = high_ - low_;
  const double largest = std::max(std::abs(low_), std::abs(high_));
  const bool flat = size <= 1e-9 * largest || size == 0.0;
  return flat ? std::max(0.05 * largest, 1e-3) : margin * size;
}

}  // namespace unisim::report
