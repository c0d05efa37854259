// SPDX-License-Identifier: MIT
// Which predictions the session asks for, and in what order.
#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

constexpr uint32_t kPair = UNISIM_REQUEST_PAIR;
constexpr uint32_t kWindow = UNISIM_REQUEST_WINDOW;

unisim_config windows_of(int32_t size, int32_t overlap) {
  unisim_config config = default_config();
  config.max_keyframes = 64;
  config.window_size = size;
  config.window_overlap = overlap;
  return config;
}

void check_request(const unisim_request& request, uint32_t kind, int32_t first, int32_t count) {
  REQUIRE(request.kind == kind);
  REQUIRE(request.count == count);
  for (int32_t k = 0; k < count; ++k) CHECK(request.keyframe_ids[k] == first + k);
}

}  // namespace

TEST_CASE("nothing is asked before there are two keyframes") {
  Host host(windows_of(4, 1));
  CHECK(host.next(kPair | kWindow).kind == 0);
  host.add_keyframe();
  CHECK(host.next(kPair | kWindow).kind == 0);
  host.add_keyframe();
  check_request(host.next(kPair), kPair, 0, 2);
}

TEST_CASE("keyframes may wait without a pose until the pairs come") {
  World world(12, 4U);
  Host host(windows_of(4, 1));
  for (int32_t id = 0; id < 8; ++id) host.add_keyframe();
  unisim_pose pose = {};
  pose.struct_size = sizeof pose;
  CHECK(unisim_get_pose(host, 0, &pose) == UNISIM_ERR_NOT_READY);
  CHECK(host.info().last_posed == -1);
  CHECK(host.info().state == UNISIM_STATE_INIT);
  CHECK(host.next(kWindow).kind == 0);
  for (int32_t i = 0; i < 7; ++i) {
    check_request(host.next(kPair), kPair, i, 2);
    REQUIRE(host.add_pair(world.pair(i)) == UNISIM_OK);
    CHECK(host.info().last_posed == i + 1);
  }
  CHECK(host.next(kPair).kind == 0);
  CHECK(host.info().state == UNISIM_STATE_TRACKING);
  check_request(host.next(kPair | kWindow), kWindow, 0, 4);
}

TEST_CASE("windows are offered oldest first, stay open, and share the overlap") {
  const int32_t overlap = GENERATE(0, 1, 3);
  World world(20, 4U);
  Host host(windows_of(4, overlap));
  for (int32_t id = 0; id < 12; ++id) {
    host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
  for (int32_t first = 0; first + 4 <= 12; first += 4 - overlap) {
    check_request(host.next(kWindow), kWindow, first, 4);
    check_request(host.next(kPair | kWindow), kWindow, first, 4);
    REQUIRE(host.add_submap(world.views({first, first + 1, first + 2, first + 3})) >= 0);
  }
  CHECK(host.next(kWindow).kind == 0);
}

TEST_CASE("a window may be answered before an older one") {
  World world(20, 4U);
  Host host(windows_of(6, 2));
  for (int32_t id = 0; id < 14; ++id) {
    host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
  CHECK(host.add_submap(world.views({4, 5, 6, 7, 8, 9})) == 0);
  CHECK(host.add_submap(world.views({8, 9, 10, 11, 12, 13})) == 1);
  check_request(host.next(kWindow), kWindow, 0, 6);
  CHECK(host.add_submap(world.views({0, 1, 2, 3, 4, 5})) == 2);
  CHECK(host.optimize().final_cost < 1e-9);
}

TEST_CASE("a window answered with fewer views is settled") {
  World world(20, 4U);
  Host host(windows_of(6, 2));
  host.feed(world, 5);
  host.add_keyframe();
  REQUIRE(host.add_pair(world.pair(4)) == UNISIM_OK);
  CHECK(host.add_submap(world.views({1, 3, 4})) == 0);
  CHECK(host.next(kWindow).kind == 0);
  CHECK(host.pose(3).confidence == 2);
  CHECK(host.pose(2).confidence == 1);
}

TEST_CASE("a rejected window is left out") {
  World world(20, 4U);
  Host host(windows_of(4, 1));
  for (int32_t id = 0; id < 7; ++id) {
    host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
  unisim_request request = host.next(kWindow);
  request.count = 3;
  CHECK(unisim_reject_request(host, &request) == UNISIM_ERR_INVALID_ARGUMENT);
  request.count = 4;
  CHECK(unisim_reject_request(host, &request) == UNISIM_OK);
  CHECK(unisim_reject_request(host, &request) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(host.info().submaps_refused == 1);
  check_request(host.next(kWindow), kWindow, 3, 4);
}

TEST_CASE("only the oldest open pair can be rejected") {
  Host host(windows_of(4, 1));
  for (int32_t id = 0; id < 3; ++id) host.add_keyframe();
  unisim_request request = host.next(kPair);
  request.keyframe_ids[0] = 1;
  request.keyframe_ids[1] = 2;
  CHECK(unisim_reject_request(host, &request) == UNISIM_ERR_INVALID_ARGUMENT);
  request.kind = UNISIM_REQUEST_LOOP;
  CHECK(unisim_reject_request(host, &request) == UNISIM_ERR_INVALID_ARGUMENT);
}

TEST_CASE("closing asks for the keyframes left over and the overlap") {
  World world(20, 4U);
  Host host(windows_of(6, 2));
  host.feed(world, 8);
  REQUIRE(unisim_close_window(host) == UNISIM_OK);
  check_request(host.next(kWindow), kWindow, 4, 4);
  CHECK(host.add_submap(world.views({4, 5, 6, 7})) == 1);
  CHECK(unisim_close_window(host) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("closing with one keyframe left over asks for nothing") {
  World world(20, 4U);
  Host host(windows_of(6, 2));
  host.feed(world, 7);
  CHECK(unisim_close_window(host) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("closing a recording shorter than a window asks for all of it") {
  World world(20, 4U);
  Host host(windows_of(16, 8));
  host.feed(world, 5);
  REQUIRE(unisim_close_window(host) == UNISIM_OK);
  check_request(host.next(kWindow), kWindow, 0, 5);
}

TEST_CASE("with the paper's preset a window waits for the pair after it, or for the end") {
  World world(20, 4U);
  unisim_config config = windows_of(4, 0);
  config.preset = UNISIM_PRESET_PAPER;
  Host host(config);
  for (int32_t id = 0; id < 4; ++id) {
    host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
  CHECK(host.next(kWindow).kind == 0);
  SECTION("pair after it") {
    host.add_keyframe();
    CHECK(host.next(kWindow).kind == 0);
    REQUIRE(host.add_pair(world.pair(3)) == UNISIM_OK);
  }
  SECTION("end") { REQUIRE(unisim_close_window(host) == UNISIM_OK); }
  check_request(host.next(kWindow), kWindow, 0, 4);
}
