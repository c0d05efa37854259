// SPDX-License-Identifier: MIT
// From one machine to another, as far as one kernel can play both: two network namespaces and a
// cable between them.
#include <lcm/lcm.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "tests/lcm/child.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/support/catch.hpp"
#include "unisim_pose_t.h"

using namespace unisim::testing;

namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=1";
constexpr int kPosesSent = 1000;
constexpr std::chrono::milliseconds kPeriod(10);
// A hang must not stop the test run.
constexpr int kLongestMs = 30000;

int64_t microseconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

bool run(const std::string& command) {
  return std::system((command + " 2> /dev/null").c_str()) == 0;
}

/// Our end of the cable: an address, up, and the way for multicast.
bool plug_in(const std::string& device, const std::string& address) {
  return run("ip address add " + address + "/24 dev " + device) &&
         run("ip link set " + device + " up") && run("ip route add 224.0.0.0/4 dev " + device);
}

struct HeardAges {
  bool in_order = true;       // the k-th pose is at k
  std::vector<int64_t> ages;  // microseconds
};

void on_stamped_pose(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
  auto* heard = static_cast<HeardAges*>(user);
  unisim_pose_t pose{};
  const int size = static_cast<int>(received->data_size);
  const bool good = unisim_pose_t_decode(received->data, 0, size, &pose) > 0;
  heard->in_order =
      heard->in_order && good && pose.pos[0] == static_cast<double>(heard->ages.size());
  heard->ages.push_back(microseconds() - pose.utime);
}

bool say(int file, char what) { return write(file, &what, 1) == 1; }

/// The other machine. @return its exit code
int hear_poses(int from_parent, int to_parent) {
  if (!enter_own_network(false).empty() || !say(to_parent, 'n')) return 1;
  if (!told(from_parent) || !plug_in("far", "10.9.8.2")) return 2;
  lcm_t* lcm = lcm_create(kUrl);
  if (lcm == nullptr) return 3;
  HeardAges heard;
  lcm_subscription_set_queue_capacity(lcm_subscribe(lcm, "UNISIM_POSE", on_stamped_pose, &heard),
                                      0);
  if (!say(to_parent, 'l')) return 4;
  while (heard.ages.size() < kPosesSent) {
    if (lcm_handle_timeout(lcm, kLongestMs) <= 0) break;
  }
  lcm_destroy(lcm);
  if (heard.ages.size() != kPosesSent) return 5;
  std::sort(heard.ages.begin(), heard.ages.end());
  const auto share = [&](int percent) {
    return heard.ages[heard.ages.size() * static_cast<size_t>(percent) / 100];
  };
  std::cout << "from publish to handler, another network, 100 a second: median " << share(50)
            << ", p95 " << share(95) << ", p99 " << share(99) << ", max " << heard.ages.back()
            << " us" << std::endl;
  return heard.in_order ? 0 : 6;
}

}  // namespace

TEST_CASE(
    "a thousand poses at a hundred a second reach another network, all of them and in order") {
  UNISIM_SKIP_WITHOUT_NETWORK(false);
  int down[2];
  int up[2];
  REQUIRE(pipe(down) == 0);
  REQUIRE(pipe(up) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    close(down[1]);
    close(up[0]);
    _exit(hear_poses(down[0], up[1]));
  }
  close(down[0]);
  close(up[1]);
  const std::string far = std::to_string(child);
  const bool cable = told(up[0]) && run("ip link add near type veth peer name far netns " + far) &&
                     plug_in("near", "10.9.8.1");
  if (!cable) {
    close(down[1]);
    waitpid(child, nullptr, 0);
    WARN("skipped: no `ip`, or this kernel makes no cable (veth)");
    return;
  }
  REQUIRE(say(down[1], 'p'));
  const Made made = make_publisher(kUrl);
  INFO(made.message);
  REQUIRE(made.publisher != nullptr);
  bool listening = told(up[0]);
  unisim_sim3 T = some_pose();
  auto next = std::chrono::steady_clock::now();
  for (int k = 0; listening && k < kPosesSent; ++k) {
    std::this_thread::sleep_until(next += kPeriod);
    T.t[0] = k;
    listening = unisim_lcm_publish_pose(made.publisher.get(), 1000 * microseconds(), &T) ==
                UNISIM_LCM_QUEUED;
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  close(down[1]);
  close(up[0]);
  CHECK(listening);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
}
