// SPDX-License-Identifier: MIT
// Selection in place.
#include "core/depth/nth_element.hpp"

#include <algorithm>

#include "core/base/check.hpp"

namespace unisim {

float nth_element(Span<float> values, int32_t k) {
  UNISIM_CHECK(k >= 0 && k < values.size());
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[k];
}

double median(Span<float> values) {
  const int32_t n = values.size();
  UNISIM_CHECK(n > 0);
  const double upper = static_cast<double>(nth_element(values, n / 2));
  if (n % 2 == 1) return upper;
  const double lower =
      static_cast<double>(*std::max_element(values.begin(), values.begin() + n / 2));
  return 0.5 * (lower + upper);
}

}  // namespace unisim
