// SPDX-License-Identifier: MIT
// The middle of some values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace unisim::drivers {

/// The upper one of two in the middle. Puts the values into another order.
/// @param values at least one
template <typename T>
T median(std::vector<T>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace unisim::drivers
