// SPDX-License-Identifier: MIT
// Selection in place.
#include "core/depth/nth_element.hpp"

#include <algorithm>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using unisim::Span;

TEST_CASE("nth_element finds every rank") {
  for (int32_t k = 0; k < 5; ++k) {
    std::vector<float> v{5, 1, 4, 1, 3};
    const float sorted[] = {1, 1, 3, 4, 5};
    CHECK(unisim::nth_element(Span<float>(v.data(), 5), k) == sorted[k]);
  }
}

TEST_CASE("median of odd and even counts") {
  std::vector<float> odd{9, 1, 5};
  CHECK(unisim::median(Span<float>(odd.data(), 3)) == 5.0);
  std::vector<float> even{9, 1, 5, 2};
  CHECK(unisim::median(Span<float>(even.data(), 4)) == 3.5);
  std::vector<float> one{2};
  CHECK(unisim::median(Span<float>(one.data(), 1)) == 2.0);
}

TEST_CASE("the median of doubles keeps their digits") {
  std::vector<double> odd{9.0, 1.0, 5.000000000123};
  CHECK(unisim::median(Span<double>(odd.data(), 3)) == 5.000000000123);
  std::vector<double> even{9.0, 1.0, 5.000000000123, 2.0};
  CHECK(unisim::median(Span<double>(even.data(), 4)) == 0.5 * (2.0 + 5.000000000123));
}

TEST_CASE("nth_element agrees with sorting on random values with ties") {
  unisim_test::Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<float> v(static_cast<size_t>(1 + random.below(300)));
    for (float& value : v) value = static_cast<float>(random.below(40));
    std::vector<float> sorted = v;
    std::sort(sorted.begin(), sorted.end());
    const int32_t size = static_cast<int32_t>(v.size());
    const int32_t k = random.below(size);
    CHECK(unisim::nth_element(Span<float>(v.data(), size), k) == sorted[static_cast<size_t>(k)]);
  }
}
