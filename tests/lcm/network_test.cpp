// SPDX-License-Identifier: MIT
// From one process to another; URLs and networks that are no good.
#include <lcm/lcm.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "tests/lcm/child.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "unisim_pose_t.h"
#include "unisim_request_t.h"

using namespace unisim::testing;

namespace {

constexpr int kPoses = 1000;
// Sent at once. The socket of a receiver that gets no processor time holds more.
constexpr int kBatch = 50;
// Far beyond what a batch takes; a hang must not stop the test run.
constexpr int kPatienceMs = 30000;

struct Heard {
  int poses = 0;
  bool in_order = true;
};

void on_pose(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
  auto* heard = static_cast<Heard*>(user);
  unisim_pose_t pose{};
  const bool good =
      unisim_pose_t_decode(received->data, 0, static_cast<int>(received->data_size), &pose) > 0;
  heard->in_order = heard->in_order && good && pose.utime == heard->poses;
  ++heard->poses;
}

/// The other process: says a byte when it listens and after each batch. @return its exit code
int hear_poses(int to_parent) {
  lcm_t* lcm = lcm_create(nullptr);
  if (lcm == nullptr) return 2;
  Heard heard;
  lcm_subscription_set_queue_capacity(lcm_subscribe(lcm, "UNISIM_POSE", on_pose, &heard), 0);
  if (write(to_parent, "r", 1) != 1) return 3;
  while (heard.poses < kPoses) {
    if (lcm_handle_timeout(lcm, kPatienceMs) <= 0) return 4;
    if (heard.poses % kBatch == 0 && write(to_parent, "b", 1) != 1) return 3;
  }
  lcm_destroy(lcm);
  return heard.in_order ? 0 : 5;
}

}  // namespace

TEST_CASE("a thousand poses reach another process, all of them and in order") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) _exit(hear_poses(ends[1]));
  close(ends[1]);
  Made made = make_publisher("");
  INFO(made.message);
  REQUIRE(made.publisher != nullptr);
  bool listening = told(ends[0]);
  const unisim_sim3 T = some_pose();
  for (int k = 0; listening && k < kPoses; ++k) {
    CHECK(unisim_lcm_publish_pose(made.publisher.get(), 1000 * k, &T) == UNISIM_LCM_QUEUED);
    if ((k + 1) % kBatch == 0) listening = told(ends[0]);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  close(ends[0]);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  unisim_lcm_publisher_counts counts{};
  counts.struct_size = sizeof counts;
  unisim_lcm_publisher_get_counts(made.publisher.get(), &counts);
  CHECK(counts.sent == kPoses);
  CHECK(counts.dropped == 0);
  CHECK(counts.failed == 0);
}

TEST_CASE("a request is heard, something else on its channel is counted") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const Made made = make_publisher("", UNISIM_LCM_UNIT_RELATIVE, 1);
  INFO(made.message);
  REQUIRE(made.publisher != nullptr);
  int32_t first = -1;
  CHECK(unisim_lcm_next_request(made.publisher.get(), &first) == 0);
  lcm_t* other = lcm_create(nullptr);
  REQUIRE(other != nullptr);
  REQUIRE(lcm_publish(other, "UNISIM_REQUEST", "rubbish", 7) == 0);
  unisim_request_t request{};
  request.what = UNISIM_REQUEST_T_TRAJECTORY;
  request.first_id = 17;
  uint8_t bytes[64];
  const int size = unisim_request_t_encode(bytes, 0, sizeof bytes, &request);
  REQUIRE(lcm_publish(other, "UNISIM_REQUEST", bytes, static_cast<unsigned>(size)) == 0);
  lcm_destroy(other);
  for (int k = 0; k < kPatienceMs && unisim_lcm_next_request(made.publisher.get(), &first) == 0;
       ++k) {
    usleep(1000);
  }
  CHECK(first == 17);
  unisim_lcm_publisher_counts counts{};
  counts.struct_size = sizeof counts;
  unisim_lcm_publisher_get_counts(made.publisher.get(), &counts);
  CHECK(counts.foreign == 1);
}

TEST_CASE("without a route for multicast the command that adds one is named") {
  UNISIM_SKIP_WITHOUT_NETWORK(false);
  const Made made = make_publisher("");
  CHECK(made.publisher == nullptr);
  CHECK(made.problem == UNISIM_LCM_NO_NETWORK);
  CHECK(has(made.message, "ip route add 224.0.0.0/4 dev lo"));
  CHECK(has(made.message, "239.255.76.67:7667"));
}

TEST_CASE("a URL that is no good is refused in one line that says why") {
  struct Case {
    const char* url;
    const char* part;
  };
  const Case cases[] = {{"nonsense", UNISIM_LCM_DEFAULT_URL},
                        {"http://239.255.76.67:7667", "'http'"},
                        {"memq://", "'memq'"},
                        {"udpm://10.0.0.1:7667", "multicast"},
                        {"udpm://host:7667", "multicast"},
                        {"udpm://239.255.76.67:70000", "1 to 65535"},
                        {"udpm://239.255.76.67:7667?ttl=300", "ttl='300'"},
                        {"udpm://239.255.76.67:7667?ttl=", "ttl=''"},
                        {"udpm://239.255.76.67:7667?speed=1", "'speed'"},
                        {"udpm://239.255.76.67:7667?recv_buf_size=x", "recv_buf_size='x'"},
                        {"file:///tmp/x.lcm", "mode=w"},
                        {"file://?mode=w", "names no file"}};
  for (const Case& one : cases) {
    const Made made = make_publisher(one.url);
    INFO(one.url << " -> " << made.message);
    CHECK(made.publisher == nullptr);
    CHECK(made.problem == UNISIM_LCM_BAD_CONFIG);
    CHECK(has(made.message, one.part));
    CHECK_FALSE(has(made.message, "\n"));
  }
}

TEST_CASE("a server that is not there is named once, with what to do") {
  const Made made = make_publisher("tcpq://127.0.0.1:1");
  CHECK(made.publisher == nullptr);
  CHECK(made.problem == UNISIM_LCM_NO_NETWORK);
  CHECK(has(made.message, "no LCM server at 127.0.0.1:1 (Connection refused); start one there"));
}

TEST_CASE("a file that cannot be made is no network") {
  const Made made = make_publisher("file:///no/such/folder/x.lcm?mode=w");
  CHECK(made.publisher == nullptr);
  CHECK(made.problem == UNISIM_LCM_NO_NETWORK);
  CHECK(has(made.message, "/no/such/folder"));
}
