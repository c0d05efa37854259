// SPDX-License-Identifier: MIT
// The consumers of drivers/lcm/examples and the tools of LCM on our channels.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include "drivers/pipeline/similarity.hpp"
#include "tests/lcm/child.hpp"
#include "tests/lcm/event_log.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/lcm/python_lcm.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

std::string position(const unisim_sim3& T) {
  char text[120];
  std::snprintf(text, sizeof text, "pos %.9f %.9f %.9f", T.t[0], T.t[1], T.t[2]);
  return text;
}

/// Poses, a correction between them, and how a consumer must answer.
void check_consumer(const std::vector<std::string>& command) {
  Child consumer(command);
  REQUIRE(consumer.wait_for("listening"));
  const Made made = make_publisher("");
  INFO(made.message);
  REQUIRE(made.publisher != nullptr);
  unisim_lcm_publisher* out = made.publisher.get();
  unisim_lcm_status status{};
  status.struct_size = sizeof status;
  status.state = UNISIM_STATE_TRACKING;
  status.confidence = 2;
  status.segment = 1;
  REQUIRE(unisim_lcm_publish_status(out, &status) == UNISIM_LCM_QUEUED);
  std::string said;
  REQUIRE(consumer.wait_for("status", &said));
  CHECK(said == "status state 1 confidence 2 unit of the map segment 1 revision 0");

  const unisim_sim3 T = some_pose();
  REQUIRE(unisim_lcm_publish_pose(out, 7000, &T) == UNISIM_LCM_QUEUED);
  REQUIRE(consumer.wait_for("pose", &said));
  CHECK(said == "pose utime 7 revision 0 " + position(T));

  unisim_lcm_correction correction{};
  correction.struct_size = sizeof correction;
  correction.map_revision = 1;
  correction.timestamp_ns = 7000;
  correction.segment = 1;
  correction.T_new_old = {{0.5, -0.5, 0.5, 0.5}, {0.1, 0.2, -0.3}, 1.5};
  REQUIRE(unisim_lcm_publish_correction(out, &correction) == UNISIM_LCM_QUEUED);
  REQUIRE(consumer.wait_for("corrected", &said));
  CHECK(said == "corrected utime 7 revision 1 " +
                    position(unisim::pipeline::compose(correction.T_new_old, T)));

  // One about an older map, after a newer pose: it moves nothing.
  REQUIRE(unisim_lcm_publish_pose(out, 9000, &T) == UNISIM_LCM_QUEUED);
  REQUIRE(consumer.wait_for("pose utime 9"));
  correction.map_revision = 2;
  correction.timestamp_ns = 8000;
  REQUIRE(unisim_lcm_publish_correction(out, &correction) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_pose(out, 10000, &T) == UNISIM_LCM_QUEUED);
  CHECK(has(consumer.line(), "pose utime 10 revision 2"));
  CHECK(consumer.line() == "done poses 3 foreign 0");
  CHECK(consumer.end() == 0);
}

/// Whole events that a log has so far.
int64_t poses_in(const std::string& log) {
  try {
    return static_cast<int64_t>(messages_on("UNISIM_POSE", log).size());
  } catch (const std::exception&) {
    return -1;  // half an event is written
  }
}

}  // namespace

TEST_CASE("the consumer in C does what README.md asks of one") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  check_consumer({UNISIM_LCM_CONSUMER, "3"});
}

TEST_CASE("a consumer can tell how old poses are when they reach it") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  Child consumer({UNISIM_LCM_AGE, "30"});
  REQUIRE(consumer.wait_for("listening"));
  const Made made = make_publisher("");
  REQUIRE(made.publisher != nullptr);
  const unisim_sim3 T = some_pose();
  for (int k = 0; k < 30; ++k) {
    const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
    const std::chrono::nanoseconds stamp = now - std::chrono::milliseconds(1000);
    REQUIRE(unisim_lcm_publish_pose(made.publisher.get(), stamp.count(), &T) == UNISIM_LCM_QUEUED);
    usleep(1000);
  }
  std::string said;
  REQUIRE(consumer.wait_for("30 poses", &said));
  double p50 = 0.0;
  REQUIRE(std::sscanf(said.c_str(), "30 poses, from the stamp of the frame to here p50 %lf",
                      &p50) == 1);
  CHECK(p50 >= 1000.0);
  CHECK(p50 < 1400.0);
  CHECK(consumer.end() == 0);
}

TEST_CASE("the consumer in Python does what README.md asks of one") {
  const TempFolder folder;
  UNISIM_SKIP_WITHOUT_PYTHON_LCM(folder.path());
  UNISIM_SKIP_WITHOUT_NETWORK();
  check_consumer({python(), UNISIM_LCM_EXAMPLES "/pose_consumer.py", "3"});
}

TEST_CASE("lcm-logger records our channels and lcm-logplayer plays them") {
  if (std::string(UNISIM_LCM_LOGGER).empty() || std::string(UNISIM_LCM_LOGPLAYER).empty()) {
    WARN("skipped: no lcm-logger or lcm-logplayer (install liblcm-bin)");
    return;
  }
  UNISIM_SKIP_WITHOUT_NETWORK();
  constexpr int64_t kPoses = 20;
  constexpr int64_t kMostPoses = 3000;  // a minute
  const TempFolder folder;
  const std::string log = folder / "run.lcm";
  const Made made = make_publisher("");
  REQUIRE(made.publisher != nullptr);
  const unisim_sim3 T = some_pose();
  int64_t sent = 0;
  {
    Child logger({UNISIM_LCM_LOGGER, "--quiet", "--flush-interval=10", log});
    // It does not say when it listens, and writes what it has when more comes.
    while (poses_in(log) < kPoses) {
      REQUIRE(unisim_lcm_publish_pose(made.publisher.get(), 1000 * ++sent, &T) ==
              UNISIM_LCM_QUEUED);
      usleep(20000);
      REQUIRE(sent < kMostPoses);
    }
    logger.send_signal(SIGINT);
    logger.end();
  }
  const std::vector<std::string> logged = messages_on("UNISIM_POSE", log);
  CHECK(static_cast<int64_t>(logged.size()) >= kPoses);
  Child consumer({UNISIM_LCM_CONSUMER, std::to_string(logged.size())});
  REQUIRE(consumer.wait_for("listening"));
  Child player({UNISIM_LCM_LOGPLAYER, "--speed=1", log});
  std::string first;
  REQUIRE(consumer.wait_for("pose utime ", &first));
  CHECK(has(first, position(T)));
  CHECK(consumer.wait_for("done poses " + std::to_string(logged.size())));
}
