// SPDX-License-Identifier: MIT
// FixedVector: capacity without growth.
#include "core/base/fixed_vector.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using unisim::Arena;
using unisim::FixedVector;

TEST_CASE("push_back fills up to the capacity and then refuses") {
  std::vector<unsigned char> memory(256);
  Arena arena(memory.data(), memory.size());
  FixedVector<int32_t> v(arena, 2);
  CHECK(v.push_back(7));
  CHECK(v.push_back(8));
  CHECK(v.full());
  CHECK_FALSE(v.push_back(9));
  REQUIRE(v.size() == 2);
  CHECK(v[0] == 7);
  CHECK(v.back() == 8);
}

TEST_CASE("pop_back and clear make room again") {
  std::vector<unsigned char> memory(256);
  Arena arena(memory.data(), memory.size());
  FixedVector<int32_t> v(arena, 1);
  CHECK(v.push_back(1));
  v.pop_back();
  CHECK(v.push_back(2));
  v.clear();
  CHECK(v.empty());
  CHECK(v.push_back(3));
  CHECK(v[0] == 3);
}
