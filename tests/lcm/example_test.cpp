// SPDX-License-Identifier: MIT
// The example of a user's C program that publishes a run with libunisim_drivers.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/lcm/child.hpp"
#include "tests/lcm/event_log.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "unisim_pose_t.h"

using namespace unisim::testing;

TEST_CASE("a C program with a camera and LCM is heard by a consumer in another process") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  Child consumer({UNISIM_LCM_CONSUMER, "20"});
  REQUIRE(consumer.wait_for("listening"));
  Child program({UNISIM_LCM_CAMERA, rendered_sequence()});
  std::string said;
  REQUIRE(consumer.wait_for("status", &said));
  CHECK(has(said, "unit of the map"));
  REQUIRE(consumer.wait_for("done poses 20 foreign 0"));
  CHECK(consumer.end() == 0);
  CHECK(program.end() == 0);
}

TEST_CASE("a C program with LCM tells all of its run") {
  const TempFolder folder;
  const std::string log = folder / "run.lcm";
  const ProgramResult run =
      run_program(UNISIM_LCM_CAMERA, {rendered_sequence(), "file://" + log + "?mode=w"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const std::vector<std::string> poses = messages_on("UNISIM_POSE", log);
  CHECK(poses.size() >= 20);
  int64_t before = -1;
  for (const std::string& bytes : poses) {
    unisim_pose_t pose{};
    REQUIRE(unisim_pose_t_decode(bytes.data(), 0, static_cast<int>(bytes.size()), &pose) > 0);
    REQUIRE(pose.utime > before);
    before = pose.utime;
  }
  for (const char* channel : {"UNISIM_KEYFRAME", "UNISIM_STATUS", "UNISIM_TRAJECTORY"}) {
    INFO(channel);
    CHECK_FALSE(messages_on(channel, log).empty());
  }
  CHECK(messages_on("UNISIM_IMAGE", log).empty());
  CHECK(messages_on("UNISIM_POINTS", log).empty());
}
