// SPDX-License-Identifier: MIT
// A message from its bytes.
#pragma once

#include <string>

#include "tests/support/catch.hpp"

namespace unisim::testing {

template <typename Message>
Message decoded(const std::string& bytes, int (*decode)(const void*, int, int, Message*)) {
  Message message{};
  REQUIRE(decode(bytes.data(), 0, static_cast<int>(bytes.size()), &message) ==
          static_cast<int>(bytes.size()));
  return message;
}

}  // namespace unisim::testing
