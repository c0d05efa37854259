// SPDX-License-Identifier: MIT
// From create to destroy the library asks the heap for nothing.
#include <cstdlib>
#include <memory>
#include <vector>

#include "tests/alloc/malloc_counter.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/owned_session.hpp"
#include "tests/support/random_session.hpp"
#include "tests/support/snapshot_bytes.hpp"
#include "unisim/places.h"

using namespace unisim::test;

TEST_CASE("the counter counts") {
  const int64_t before = heap_calls();
  std::unique_ptr<int> block(new int(5));
  void* volatile raw = std::malloc(100);
  std::free(raw);
  CHECK(heap_calls() >= before + 3);
}

TEST_CASE("a long random session makes no heap call") {
  const auto overlap = GENERATE(2, 8);
  const auto window_submaps = GENERATE(0, 2);
  unisim_config config;
  REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
  config.max_keyframes = 600;
  config.window_overlap = overlap;
  config.window_submaps = window_submaps;
  config.skeleton_capacity = 8;
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  std::unique_ptr<unsigned char[]> arena(new unsigned char[size]);
  unisim_session* session = nullptr;
  const int64_t before_create = heap_calls();
  unisim_status status = unisim_session_create(&session, &config, arena.get(), size);
  const int64_t in_create = heap_calls() - before_create;
  REQUIRE(status == UNISIM_OK);
  CHECK(in_create == 0);

  Habits habits;
  habits.metres = 0.2;
  RandomCaller caller(session, config, 17U, habits);
  const int64_t before = heap_calls();
  while (caller.step()) {
  }
  status = unisim_session_reset(session);
  unisim_session_destroy(session);
  const int64_t during = heap_calls() - before;
  CHECK(during == 0);
  CHECK(status == UNISIM_OK);
  CHECK(caller.count(UNISIM_OK) > 2000);
  CHECK(caller.count(UNISIM_ERR_INTERNAL) == 0);
}

TEST_CASE("twenty thousand keyframes in a sliding window make no heap call") {
  unisim_config config;
  REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
  config.window_submaps = 2;
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  std::unique_ptr<unsigned char[]> arena(new unsigned char[size]);
  unisim_session* session = nullptr;
  REQUIRE(unisim_session_create(&session, &config, arena.get(), size) == UNISIM_OK);
  Habits habits;
  habits.keyframes = 20000;
  habits.reads = 0.02;
  habits.optimizes = 0.1;
  RandomCaller caller(session, config, 5U, habits);
  const int64_t before = heap_calls();
  while (caller.step()) {
  }
  const int64_t during = heap_calls() - before;
  CHECK(during == 0);
  CHECK(caller.count(UNISIM_ERR_CAPACITY) == 0);
  CHECK(caller.count(UNISIM_ERR_INTERNAL) == 0);
  unisim_session_info info = {};
  info.struct_size = sizeof info;
  REQUIRE(unisim_get_info(session, &info) == UNISIM_OK);
  CHECK(info.keyframes == 20000);
  CHECK(info.first_keyframe > 18000);
  CHECK(info.retired_keyframes > 10000);
}

TEST_CASE("saving and loading a map makes no heap call") {
  const auto window_submaps = GENERATE(0, 2);
  unisim_config config;
  REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
  config.max_keyframes = 200;
  config.window_submaps = window_submaps;
  OwnedSession owned(config);
  Habits habits;
  habits.keyframes = 150;
  RandomCaller caller(owned.session, config, 17U, habits);
  while (caller.step()) {
  }
  SnapshotBytes snapshot;
  snapshot.bytes.reserve(4000000);
  SnapshotBytes nothing;
  unisim_load_report report = {};
  report.struct_size = sizeof report;
  int32_t failures = 0;
  const int64_t before = heap_calls();
  failures += unisim_save_map(owned.session, SnapshotBytes::write, &snapshot) != UNISIM_OK;
  failures += unisim_session_reset(owned.session) != UNISIM_OK;
  failures += unisim_load_map(owned.session, SnapshotBytes::take, &nothing) != UNISIM_ERR_IO;
  failures += unisim_get_load_report(owned.session, &report) != UNISIM_OK;
  failures += unisim_load_map(owned.session, SnapshotBytes::take, &snapshot) != UNISIM_OK;
  CHECK(heap_calls() == before);
  CHECK(failures == 0);
  CHECK(snapshot.bytes.size() > 100000);
}

TEST_CASE("an index of places makes no heap call") {
  unisim_places_config config;
  REQUIRE(unisim_places_config_init(&config, sizeof config) == UNISIM_OK);
  config.capacity = 20;
  config.dimension = 64;
  config.same_place = 0.0;
  size_t size = 0;
  REQUIRE(unisim_places_arena_size(&config, &size) == UNISIM_OK);
  std::vector<unsigned char> arena(size);
  std::vector<int8_t> descriptor(64, 1);
  unisim_places_question question = {};
  question.struct_size = sizeof question;
  question.descriptor = descriptor.data();
  unisim_places_match matches[8];
  int32_t evictions = 0;
  int32_t failures = 0;
  const int64_t before = heap_calls();
  unisim_places* places = nullptr;
  failures += unisim_places_create(&places, &config, arena.data(), size) != UNISIM_OK;
  for (int32_t id = 0; id < 200; ++id) {
    for (size_t k = 0; k < descriptor.size(); ++k) {
      descriptor[k] = static_cast<int8_t>((id + static_cast<int32_t>(k * k)) % 100 + 1);
    }
    int32_t evicted = -1;
    int32_t count = 0;
    failures += unisim_places_add(places, id, descriptor.data(), &evicted) != UNISIM_OK;
    failures += unisim_places_query(places, &question, matches, 8, &count) != UNISIM_OK;
    evictions += evicted >= 0 ? 1 : 0;
  }
  unisim_places_destroy(places);
  CHECK(heap_calls() == before);
  CHECK(failures == 0);
  CHECK(evictions == 180);
}
