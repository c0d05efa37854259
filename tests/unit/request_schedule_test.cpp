// SPDX-License-Identifier: MIT
// What is asked for next: pairs in a row, windows as soon as they may be answered.
#include "core/map/request_schedule.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

namespace {

constexpr uint32_t kBoth = kRequestPair | kRequestWindow;

/// Windows of four keyframes that share one.
struct ScheduleFixture {
  explicit ScheduleFixture(bool unit_by_next = false)
      : memory(65536),
        arena(memory.data(), memory.size()),
        keyframes(arena, 32),
        requests(keyframes, WindowSchedule(arena, 4, 1, 8, true, 0), unit_by_next) {}

  void add_keyframes(int32_t count) {
    for (int32_t k = 0; k < count; ++k) {
      keyframes.append(keyframes.size());
      Window skipped;
      CHECK(requests.keyframe_added(&skipped));
    }
  }

  std::vector<unsigned char> memory;
  Arena arena;
  KeyframeRing keyframes;
  RequestSchedule requests;
  Request request;
};

}  // namespace

TEST_CASE("the pair behind the last settled keyframe is asked for") {
  ScheduleFixture f;
  CHECK(f.requests.next(kBoth, &f.request) == Status::kNotReady);
  f.add_keyframes(3);
  f.keyframes.settle(1);
  REQUIRE(f.requests.next(kBoth, &f.request) == Status::kOk);
  CHECK(f.request.kind == kRequestPair);
  CHECK(f.request.keyframes.first == 1);
  CHECK(f.requests.wants(f.request));
  f.keyframes.settle(2);
  CHECK_FALSE(f.requests.wants(f.request));
}

TEST_CASE("a window is asked for once its keyframes are settled, before newer pairs") {
  ScheduleFixture f;
  f.add_keyframes(5);
  f.keyframes.settle(2);
  CHECK(f.requests.next(kRequestWindow, &f.request) == Status::kNotReady);
  f.keyframes.settle(3);
  REQUIRE(f.requests.next(kBoth, &f.request) == Status::kOk);
  CHECK(f.request.kind == kRequestWindow);
  CHECK(f.request.keyframes.last() == 3);
  int32_t index = -1;
  REQUIRE(f.requests.find_window(0, 3, &index) == Status::kOk);
  CHECK(f.requests.take_window(index).count == 4);
  CHECK_FALSE(f.requests.wants(f.request));
}

TEST_CASE("where the next pair gives the unit a window waits for it, or for the end") {
  ScheduleFixture f(true);
  f.add_keyframes(4);
  f.keyframes.settle(3);
  int32_t index = -1;
  CHECK(f.requests.find_window(0, 3, &index) == Status::kNotReady);
  SECTION("the pair comes") {
    f.add_keyframes(1);
    f.keyframes.settle(4);
    CHECK(f.requests.find_window(0, 3, &index) == Status::kOk);
  }
  SECTION("the host says that none will come") {
    CHECK(f.requests.close_window() == Status::kOk);
    CHECK(f.requests.find_window(0, 3, &index) == Status::kOk);
  }
}

TEST_CASE("closing cuts a window from what is left over") {
  ScheduleFixture f;
  f.add_keyframes(6);
  f.keyframes.settle(5);
  int32_t index = -1;
  CHECK(f.requests.find_window(3, 5, &index) == Status::kInvalidArgument);
  CHECK(f.requests.close_window() == Status::kOk);
  CHECK(f.requests.find_window(3, 5, &index) == Status::kOk);
  CHECK(f.requests.close_window() == Status::kNotReady);
}

TEST_CASE("windows over keyframes that have gone are given up oldest first") {
  ScheduleFixture f;
  f.add_keyframes(10);
  Window dropped;
  REQUIRE(f.requests.drop_before(4, &dropped));
  CHECK(dropped.first == 0);
  REQUIRE(f.requests.drop_before(4, &dropped));
  CHECK(dropped.first == 3);
  CHECK_FALSE(f.requests.drop_before(4, &dropped));
  CHECK(f.requests.has_window_over(6));
  CHECK_FALSE(f.requests.has_window_over(5));
}
