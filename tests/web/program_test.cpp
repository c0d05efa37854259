// SPDX-License-Identifier: MIT
// unisim-live --web as its users start it.
#include "tests/replay/program.hpp"

#include <string>

#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "tools/live/web/server.hpp"

using namespace unisim::testing;
using namespace unisim::live::web;

namespace {

ProgramResult run_live(const std::vector<std::string>& arguments) {
  return run_program(UNISIM_LIVE_PROGRAM, arguments);
}

}  // namespace

TEST_CASE("a run with a page says where it is, and ends as one without") {
  const ProgramResult live = run_live({"--device", small_sequence(), "--web", "0"});
  INFO(live.err);
  CHECK(live.code == 0);
  CHECK(has(live.err, "page: http://127.0.0.1:"));
}

TEST_CASE("a page that cannot be served ends the run before it begins") {
  Feed feed("test");
  const Server other(&feed, Address(), "");
  const std::string port = other.url().substr(other.url().rfind(':') + 1,
                                              other.url().size() - other.url().rfind(':') - 2);
  const ProgramResult taken = run_live({"--device", small_sequence(), "--web", port});
  CHECK(taken.code == 4);
  CHECK(has(taken.err, "--web 127.0.0.1:" + port + ": Address already in use"));
  const ProgramResult open = run_live({"--device", small_sequence(), "--web", "0.0.0.0:0"});
  CHECK(open.code == 2);
  CHECK(has(open.err, "--web-token"));
  const ProgramResult alone = run_live({"--device", small_sequence(), "--web-token", "x"});
  CHECK(alone.code == 2);
}
