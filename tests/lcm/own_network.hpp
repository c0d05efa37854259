// SPDX-License-Identifier: MIT
// A network of the test's own, in which it hears nobody else and nobody hears it.
#pragma once

#include <string>

namespace unisim::testing {

/// Moves this thread, and what it starts from now on, into a new network with a loopback device
/// that is up. @param route with a route for multicast
/// @return "", or why that is not possible here
std::string enter_own_network(bool route = true);

#define UNISIM_SKIP_WITHOUT_NETWORK(...)                                         \
  {                                                                              \
    const std::string why_not = unisim::testing::enter_own_network(__VA_ARGS__); \
    if (!why_not.empty()) {                                                      \
      WARN("skipped: no network of its own for this test: " << why_not);         \
      return;                                                                    \
    }                                                                            \
  }

}  // namespace unisim::testing
