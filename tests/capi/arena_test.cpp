// SPDX-License-Identifier: MIT
// The arena: exact size, any alignment, nothing touched outside it; declared capacities.
#include <cstring>
#include <vector>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

size_t size_of(const unisim_config& config) {
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  return size;
}

unisim_config arena_config() {
  unisim_config config = default_config();
  config.max_keyframes = 24;
  config.window_size = 6;
  config.max_loops = 2;
  return config;
}

}  // namespace

TEST_CASE("one byte less than unisim_arena_size is out of memory") {
  unisim_config config = arena_config();
  config.window_overlap = GENERATE(0, 2, 5);
  const size_t size = size_of(config);
  std::vector<unsigned char> arena(size);
  unisim_session* session = nullptr;
  CHECK(unisim_session_create(&session, &config, arena.data(), size - 1) ==
        UNISIM_ERR_OUT_OF_MEMORY);
  CHECK(unisim_session_create(&session, &config, arena.data(), 0) == UNISIM_ERR_OUT_OF_MEMORY);
  CHECK(session == nullptr);
  CHECK(unisim_session_create(&session, &config, arena.data(), size) == UNISIM_OK);
}

TEST_CASE("any alignment of the arena works and nothing outside it is written") {
  const unisim_config config = arena_config();
  const size_t size = size_of(config);
  const auto shift = static_cast<size_t>(GENERATE(range(0, 65)));
  std::vector<unsigned char> memory(size + 256, 0xA5);
  unsigned char* arena = memory.data() + 64 + shift;
  unisim_session* session = nullptr;
  REQUIRE(unisim_session_create(&session, &config, arena, size) == UNISIM_OK);
  unisim_keyframe keyframe = {sizeof keyframe, 0, 5};
  int32_t id = -1;
  CHECK(unisim_add_keyframe(session, &keyframe, &id) == UNISIM_OK);
  unisim_session_destroy(session);
  const std::vector<unsigned char> untouched(64, 0xA5);
  CHECK(std::memcmp(arena - 64, untouched.data(), 64) == 0);
  CHECK(std::memcmp(arena + size, untouched.data(), 64) == 0);
}

TEST_CASE("the parts of the arena add up to its size") {
  const unisim_config config = default_config();
  std::vector<unisim_arena_part> parts(32);
  size_t count = 0;
  CHECK(unisim_arena_parts(&config, nullptr, 0, &count) == UNISIM_ERR_CAPACITY);
  const size_t needed = count;
  REQUIRE(unisim_arena_parts(&config, parts.data(), parts.size(), &count) == UNISIM_OK);
  CHECK(count == needed);
  size_t sum = 0;
  for (size_t i = 0; i < count; ++i) {
    CHECK(std::strlen(parts[i].name) > 0);
    sum += parts[i].bytes;
  }
  CHECK(sum == size_of(config));
}

TEST_CASE("a session filled to its keyframe capacity works and refuses one more") {
  unisim_config config = arena_config();
  config.window_overlap = GENERATE(0, 1, 2, 3, 4, 5);
  World world(config.max_keyframes, 11U);
  Host host(config);
  host.feed(world, config.max_keyframes);
  unisim_keyframe keyframe = {sizeof keyframe, 0, int64_t{1} << 40};
  int32_t id = -7;
  CHECK(unisim_add_keyframe(host, &keyframe, &id) == UNISIM_ERR_CAPACITY);
  CHECK(id == -7);
  CHECK(host.info().keyframes == config.max_keyframes);
  if (unisim_close_window(host) == UNISIM_OK) {
    const unisim_request tail = host.next(UNISIM_REQUEST_WINDOW);
    REQUIRE(tail.kind == UNISIM_REQUEST_WINDOW);
    CHECK(host.add_submap(world.views({tail.keyframe_ids, tail.keyframe_ids + tail.count})) >= 0);
  }
  CHECK(host.add_loop(world.views({0, 1, 2, 21, 22, 23})) >= 0);
  CHECK(host.add_loop(world.views({1, 2, 20, 21, 22, 23})) >= 0);
  const Views extra = world.views({2, 3, 4, 20, 21, 22});
  const unisim_submap loop = extra.submap();
  CHECK(unisim_add_loop(host, &loop, &id) == UNISIM_ERR_CAPACITY);
  CHECK(host.info().loops == 2);
  CHECK(host.optimize().final_cost < 1e-8);
}

TEST_CASE("a prediction with more views than the window size is over capacity") {
  const unisim_config config = arena_config();
  World world(config.max_keyframes, 11U);
  Host host(config);
  host.feed(world, 12);
  const Views views = world.views({0, 1, 2, 3, 8, 9, 10});
  const unisim_submap loop = views.submap();
  int32_t id = -7;
  CHECK(unisim_add_loop(host, &loop, &id) == UNISIM_ERR_CAPACITY);
}

TEST_CASE("windows beyond max_submaps are skipped, the rest goes on") {
  unisim_config config = arena_config();
  config.max_submaps = 2;
  World world(config.max_keyframes, 11U);
  Host host(config);
  host.feed(world, config.max_keyframes);
  CHECK(host.info().submaps == 2);
  CHECK(host.info().posed_keyframes == config.max_keyframes);
  CHECK(host.optimize().final_cost < 1e-8);
}

TEST_CASE("closing the window at every turn stays within capacity") {
  unisim_config config = arena_config();
  config.window_overlap = 5;
  World world(config.max_keyframes, 11U);
  Host host(config);
  for (int32_t id = 0; id < config.max_keyframes; ++id) {
    host.feed(world, 1);
    if (unisim_close_window(host) != UNISIM_OK) continue;
    const unisim_request tail = host.next(UNISIM_REQUEST_WINDOW);
    if (tail.kind == 0) continue;
    CHECK(host.add_submap(world.views({tail.keyframe_ids, tail.keyframe_ids + tail.count})) >= 0);
  }
  CHECK(host.optimize().final_cost < 1e-8);
}

TEST_CASE("loops between many places at capacity can be factorised") {
  unisim_config config = default_config();
  config.max_keyframes = 200;
  config.max_loops = 40;
  config.window_size = 8;
  World world(200, 2U);
  Host host(config);
  host.feed(world, 200);
  std::mt19937 random(9U);
  std::uniform_int_distribution<int32_t> place(0, 195);
  while (host.info().loops < config.max_loops) {
    const int32_t a = place(random);
    const int32_t b = place(random);
    if (b < a + 4) continue;
    CHECK(host.add_loop(world.views({a, a + 1, a + 2, a + 3, b, b + 1, b + 2, b + 3})) >= 0);
  }
  CHECK(host.optimize().final_cost < 1e-6);
}

TEST_CASE("reset gives back a session as created") {
  const unisim_config config = arena_config();
  World world(config.max_keyframes, 11U);
  Host host(config);
  host.feed(world, 12);
  REQUIRE(unisim_session_reset(host) == UNISIM_OK);
  const unisim_session_info info = host.info();
  CHECK(info.keyframes == 0);
  CHECK(info.submaps == 0);
  CHECK(info.state == UNISIM_STATE_INIT);
  unisim_keyframe keyframe = {sizeof keyframe, 0, 0};
  int32_t id = -1;
  CHECK(unisim_add_keyframe(host, &keyframe, &id) == UNISIM_OK);
  CHECK(id == 0);
}
