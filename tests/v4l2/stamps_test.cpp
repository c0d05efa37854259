// SPDX-License-Identifier: MIT
// Time stamps of whatever clock on one, and gaps in the count of frames.
#include "drivers/v4l2/sequence_count.hpp"
#include "drivers/v4l2/stamp_clock.hpp"
#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {
namespace {

using v4l2::SequenceCount;
using v4l2::StampClock;

constexpr int64_t kSecondNs = 1'000'000'000;
constexpr int64_t kPeriod = kSecondNs / 30;
constexpr int64_t kNow = 5000 * kSecondNs;
constexpr int64_t kWallClock = 1'700'000'000 * kSecondNs;

}  // namespace

TEST_CASE("a stamp of the monotonic clock stays as it is") {
  StampClock clock;
  const auto stamp = clock.map(kNow - 20'000'000, {kNow, kWallClock}, kPeriod);
  CHECK(stamp.ns == kNow - 20'000'000);
  CHECK(stamp.measured);
}

TEST_CASE("a stamp of the wall clock is moved to the monotonic one, also when that is set") {
  StampClock clock;
  auto stamp = clock.map(kWallClock - 20'000'000, {kNow, kWallClock}, kPeriod);
  CHECK(stamp.ns == kNow - 20'000'000);
  CHECK(stamp.measured);
  const int64_t set_back = kWallClock - 3600 * kSecondNs;
  stamp = clock.map(set_back - 5'000'000, {kNow + kPeriod, set_back}, kPeriod);
  CHECK(stamp.ns == kNow + kPeriod - 5'000'000);
}

TEST_CASE("a stamp of no clock is replaced by the moment of arrival") {
  for (const int64_t raw : {int64_t{0}, int64_t{17}, -5 * kSecondNs, kNow / 2, INT64_MAX / 2}) {
    StampClock clock;
    const auto stamp = clock.map(raw, {kNow, kWallClock}, kPeriod);
    CHECK(stamp.ns == kNow);
    CHECK_FALSE(stamp.measured);
  }
}

TEST_CASE("no stamp is ahead of the clock") {
  StampClock clock;
  const auto stamp = clock.map(kNow + 178'000'000, {kNow, kWallClock}, kPeriod);
  CHECK(stamp.ns == kNow);
  CHECK_FALSE(stamp.measured);
}

TEST_CASE("stamps that repeat or go back grow by a period at most") {
  StampClock clock;
  const int64_t first = kNow - 20'000'000;
  clock.map(first, {kNow, kWallClock}, kPeriod);
  auto stamp = clock.map(first, {kNow + kPeriod, kWallClock}, kPeriod);
  CHECK(stamp.ns == first + kPeriod);
  stamp = clock.map(first - kSecondNs, {kNow + kPeriod + 5, kWallClock}, kPeriod);
  CHECK(stamp.ns == kNow + kPeriod + 5);
  stamp = clock.map(first - kSecondNs, {kNow + kPeriod + 5, kWallClock}, kPeriod);
  CHECK(stamp.ns == kNow + kPeriod + 6);
}

TEST_CASE("lost frames are counted by gaps, right across the end of the numbers") {
  SequenceCount count;
  CHECK(count.lost_before(0xfffffffe, kNow, kPeriod) == 0);
  CHECK(count.lost_before(0xffffffff, kNow + kPeriod, kPeriod) == 0);
  CHECK(count.lost_before(2, kNow + 4 * kPeriod, kPeriod) == 2);
  CHECK(count.lost_before(3, kNow + 5 * kPeriod, kPeriod) == 0);
}

TEST_CASE("numbers that repeat, go back or jump in no time are no loss") {
  SequenceCount count;
  CHECK(count.lost_before(0, kNow, kPeriod) == 0);
  CHECK(count.lost_before(13, kNow + kPeriod, kPeriod) == 0);
  CHECK(count.lost_before(13, kNow + 2 * kPeriod, kPeriod) == 0);
  CHECK(count.lost_before(1, kNow + 3 * kPeriod, kPeriod) == 0);
  CHECK(count.lost_before(0x80000000, kNow + 4 * kPeriod, kPeriod) == 0);
  CHECK(count.lost_before(0x80000002, kNow + 6 * kPeriod, kPeriod) == 1);
}

TEST_CASE("whatever stamps a camera gives, those of the frames grow and are not ahead") {
  int64_t (*const habits[])(int64_t now, uint32_t n) = {
      [](int64_t, uint32_t) { return int64_t{0}; },
      [](int64_t now, uint32_t) { return now + 30'000'000; },
      [](int64_t now, uint32_t n) { return n % 3 == 0 ? now - kSecondNs : now; },
      [](int64_t now, uint32_t) { return now / kSecondNs * kSecondNs; },
      [](int64_t, uint32_t) { return INT64_MAX; },
      [](int64_t, uint32_t) { return -kSecondNs; },
      [](int64_t now, uint32_t) { return now + 1'700'000'000 * kSecondNs; },
  };
  for (const auto habit : habits) {
    CameraRun run;
    make_small(&run);
    run.camera->script = [habit](FakeFrame* frame) {
      // The first are as they should be: old ones would be left-overs.
      if (frame->sequence > 8) frame->stamp_ns = habit(frame->stamp_ns, frame->sequence);
    };
    REQUIRE(run.open());
    int64_t last_ns = 0;
    for (int i = 0; i < 40; ++i) {
      REQUIRE(run.next() == UNISIM_FRAME_OK);
      CHECK(run.frame.timestamp_ns > last_ns);
      CHECK(run.frame.timestamp_ns <= run.io.now_ns());
      CHECK(run.frame.timestamp_ns > run.io.now_ns() - kSecondNs);
      last_ns = run.frame.timestamp_ns;
    }
  }
}

TEST_CASE("frames lost on the way leave a gap in the index and are counted") {
  CameraRun run;
  make_small(&run);
  run.camera->script = [](FakeFrame* frame) {
    frame->never_comes = frame->sequence == 2 || frame->sequence == 3;
  };
  REQUIRE(run.open());
  std::vector<int64_t> indices;
  for (int i = 0; i < 4; ++i) {
    REQUIRE(run.next() == UNISIM_FRAME_OK);
    indices.push_back(run.frame.index);
  }
  CHECK(indices == std::vector<int64_t>{0, 1, 4, 5});
  CHECK(run.statistics().lost == 2);
}

}  // namespace unisim::test
