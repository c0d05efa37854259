// SPDX-License-Identifier: MIT
// Selection in place.
#include "core/depth/nth_element.hpp"

#include <algorithm>

#include "core/base/check.hpp"

namespace unisim {
namespace {

template <class T>
T select(Span<T> values, int32_t k) {
  UNISIM_CHECK(k >= 0 && k < values.size());
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[k];
}

template <class T>
double middle(Span<T> values) {
  const int32_t n = values.size();
  UNISIM_CHECK(n > 0);
  const auto upper = static_cast<double>(select(values, n / 2));
  if (n % 2 == 1) return upper;
  const auto lower = static_cast<double>(*std::max_element(values.begin(), values.begin() + n / 2));
  return 0.5 * (lower + upper);
}

}  // namespace

float nth_element(Span<float> values, int32_t k) { return select(values, k); }

double median(Span<float> values) { return middle(values); }

double median(Span<double> values) { return middle(values); }

}  // namespace unisim
