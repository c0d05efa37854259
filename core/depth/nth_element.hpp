// SPDX-License-Identifier: MIT
// Selection in place: the k-th smallest and the median of an array.
#pragma once

#include "core/base/span.hpp"

namespace unisim {

/// The k-th smallest value (k from 0). Reorders `values`: smaller or equal ones before position k,
/// larger or equal ones after it. Values must be finite; linear on average.
float nth_element(Span<float> values, int32_t k);

/// Median; the mean of the two middle values for an even count. Reorders `values`, which has at
/// least one element.
double median(Span<float> values);
double median(Span<double> values);

}  // namespace unisim
