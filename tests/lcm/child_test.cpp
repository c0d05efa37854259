// SPDX-License-Identifier: MIT
// A program that does not end must not stop the test run.
#include "tests/lcm/child.hpp"

#include <catch2/catch.hpp>
#include <csignal>

namespace unisim::testing {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("the exit code or the signal of a child that ends is told", "[lcm]") {
  CHECK(Child({"sh", "-c", "echo; echo last; exit 7"}).end() == 7);
  CHECK(Child({"sh", "-c", "kill -TERM $$"}).end() == 128 + SIGTERM);
}

TEST_CASE("a child that does not end is killed, and the test told", "[lcm]") {
  const char* kind = GENERATE("exec sleep 600", "exec sleep 600 >&-", "exec yes");
  CAPTURE(kind);
  Child child({"sh", "-c", kind});
  CHECK_THROWS_WITH(child.end(300), Contains("sh did not end within 300 ms and was killed"));
}

}  // namespace
}  // namespace unisim::testing
