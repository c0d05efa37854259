// SPDX-License-Identifier: MIT
// What has retired is offered once, and counted where it was lost.
#include "core/skeleton/outbox.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

namespace {

struct OutboxFixture {
  OutboxFixture()
      : memory(65536),
        arena(memory.data(), memory.size()),
        keyframes(arena, 8),
        outbox(arena, 3, 0) {
    for (int32_t id = 0; id < 6; ++id) {
      keyframes.append(100 * id);
      keyframes[id].owner = 40;
    }
  }
  void add_merges(int32_t from, int32_t count) {
    for (int32_t k = from; k < from + count; ++k) {
      Retired merge;
      merge.submap = k;
      outbox.add_merge(merge);
    }
  }

  std::vector<unsigned char> memory;
  Arena arena;
  KeyframeRing keyframes;
  Outbox outbox;
};

}  // namespace

TEST_CASE("retired keyframes are offered in order, once, up to those that have not retired") {
  OutboxFixture f;
  Retired retired;
  for (int32_t id = 0; id < 4; ++id) {
    REQUIRE(f.outbox.next(f.keyframes, 4, &retired) == Status::kOk);
    CHECK(retired.keyframe == id);
    CHECK(retired.timestamp_ns == 100 * id);
    CHECK(retired.submap == 40);
  }
  CHECK(f.outbox.next(f.keyframes, 4, &retired) == Status::kNotReady);
}

TEST_CASE("a keyframe without a pose is passed over, a held one goes with the one that holds it") {
  OutboxFixture f;
  f.keyframes[0].owner = -1;
  f.keyframes[2].owner = -1;
  f.keyframes[2].held_from = 1;
  f.keyframes[1].T_owner_kf.t = {1.0, 2.0, 3.0};
  Retired retired;
  REQUIRE(f.outbox.next(f.keyframes, 3, &retired) == Status::kOk);
  CHECK(retired.keyframe == 1);
  REQUIRE(f.outbox.next(f.keyframes, 3, &retired) == Status::kOk);
  CHECK(retired.keyframe == 2);
  CHECK(retired.T.t[2] == 3.0);
  CHECK(f.outbox.next(f.keyframes, 3, &retired) == Status::kNotReady);
}

TEST_CASE("keyframes that are forgotten before they were fetched count as unread") {
  OutboxFixture f;
  f.keyframes[2].owner = -1;  // has no pose: nothing is lost
  Retired retired;
  REQUIRE(f.outbox.next(f.keyframes, 6, &retired) == Status::kOk);
  f.outbox.lose_through(f.keyframes, 3);
  CHECK(f.outbox.unread() == 2);
  REQUIRE(f.outbox.next(f.keyframes, 6, &retired) == Status::kOk);
  CHECK(retired.keyframe == 4);
}

TEST_CASE("merges wait in a ring of their own, the oldest are lost") {
  OutboxFixture f;
  f.add_merges(0, 2);
  Retired retired;
  REQUIRE(f.outbox.next(f.keyframes, 0, &retired) == Status::kOk);
  CHECK(retired.keyframe == -1);
  CHECK(retired.submap == 0);
  f.add_merges(2, 4);
  for (int32_t submap = 3; submap < 6; ++submap) {
    REQUIRE(f.outbox.next(f.keyframes, 0, &retired) == Status::kOk);
    CHECK(retired.submap == submap);
  }
  CHECK(f.outbox.next(f.keyframes, 0, &retired) == Status::kNotReady);
  CHECK(f.outbox.unread() == 2);
}
