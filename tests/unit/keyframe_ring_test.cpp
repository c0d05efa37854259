// SPDX-License-Identifier: MIT
// The ring of keyframes: ids grow, the newest stay.
#include "core/map/keyframe_ring.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

TEST_CASE("a ring keeps the newest keyframes under ids that grow") {
  std::vector<unsigned char> memory(4096);
  Arena arena(memory.data(), memory.size());
  KeyframeRing ring(arena, 3);
  for (int32_t k = 0; k < 5; ++k) CHECK(ring.append(100 + k) == k);
  CHECK(ring.size() == 5);
  CHECK(ring.first() == 2);
  CHECK(ring.full());
  CHECK(ring.gone(1));
  CHECK_FALSE(ring.has(1));
  CHECK_FALSE(ring.gone(5));
  CHECK_FALSE(ring.gone(-1));
  for (int32_t id = 2; id < 5; ++id) CHECK(ring[id].timestamp_ns == 100 + id);
  ring.forget_before(4);
  CHECK(ring.first() == 4);
  CHECK_FALSE(ring.full());
  ring.forget_before(3);
  CHECK(ring.first() == 4);
}

TEST_CASE("a held keyframe whose source is gone has no pose") {
  std::vector<unsigned char> memory(4096);
  Arena arena(memory.data(), memory.size());
  KeyframeRing ring(arena, 2);
  const int32_t posed = ring.append(1);
  ring[posed].node = 0;
  const int32_t held = ring.append(2);
  ring[held].held_from = posed;
  CHECK(ring.pose_source(held) == posed);
  ring.append(3);
  CHECK(ring.pose_source(held) == -1);
}
