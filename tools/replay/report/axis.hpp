// SPDX-License-Identifier: MIT
// A range of values on a drawing, with ticks at round numbers.
#pragma once

#include <vector>

namespace unisim::report {

/// Values low..high lie on pixels from..to (to < from: growing upwards).
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double from = 0.0;
  double to = 1.0;

  double pixel(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

/// Distance between ticks: 1, 2 or 5 times a power of ten, about `wanted` of them in the range.
double tick_step(double low, double high, int wanted);

/// Multiples of `step` within the range.
std::vector<double> ticks(double low, double high, double step);

/// The smallest range that holds all finite values, widened by `margin` of itself. With a margin a
/// single value gets some room too.
class Range {
 public:
  void add(double value);
  bool empty() const { return !(low_ <= high_); }
  double low(double margin = 0.0) const { return low_ - pad(margin); }
  double high(double margin = 0.0) const { return high_ + pad(margin); }

 private:
  double pad(double margin) const;

  double low_ = 1e300;
  double high_ = -1e300;
};

}  // namespace unisim::report
