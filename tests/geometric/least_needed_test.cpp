// SPDX-License-Identifier: MIT
// Which keyframe leaves a full map, and what stays of its landmarks.
#include "drivers/geometric/map/least_needed.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace unisim::geometric {
namespace {

constexpr int32_t kCapacity = 8;

LandmarkMap empty_map() { return LandmarkMap({kCapacity, 64, 16}); }

void push(LandmarkMap* map, int32_t id, bool posed = true) {
  map->push_keyframe(id, 0).posed = posed;
}

/// A landmark with a place, seen in the given keyframes.
int32_t add_landmark(LandmarkMap* map, const std::vector<int32_t>& views) {
  const int32_t slot = map->add_landmark(0);
  map->landmark(slot).state = LandmarkState::kPlaced;
  for (const int32_t id : views) map->observe_in(id, slot, {1, 1});
  return slot;
}

std::vector<int32_t> views_of(const LandmarkMap& map, int32_t slot) {
  std::vector<int32_t> views;
  map.for_each_observation(slot, [&](const ObservationRef& ref, const Observation& seen) {
    CHECK(seen.landmark == slot);
    views.push_back(ref.keyframe);
  });
  return views;
}

TEST_CASE("the keyframe whose landmarks the others see too leaves a full map") {
  LandmarkMap map = empty_map();
  for (int32_t id = 0; id < kCapacity; ++id) push(&map, id);
  add_landmark(&map, {0, 1});
  const int32_t common = add_landmark(&map, {1, 2, 3, 4, 5, 6});
  add_landmark(&map, {3, 7});
  CHECK(least_needed_keyframe(map) == 2);
  push(&map, 20);
  CHECK_FALSE(map.holds(2));
  CHECK(map.ids() == std::vector<int32_t>{0, 1, 3, 4, 5, 6, 7, 20});
  CHECK(views_of(map, common) == std::vector<int32_t>{1, 3, 4, 5, 6});
  CHECK(map.landmark(common).observations == 5);
}

TEST_CASE("keyframes without a pose leave first, but not while they are new") {
  LandmarkMap map = empty_map();
  for (int32_t id = 0; id < kCapacity; ++id) push(&map, id, id != 3 && id != 6);
  add_landmark(&map, {0, 1, 2, 4, 5, 7});
  CHECK(least_needed_keyframe(map) == 3);
  push(&map, 8);
  CHECK(least_needed_keyframe(map) != 6);
}

TEST_CASE("a path without return is forgotten from its beginning") {
  LandmarkMap map = empty_map();
  for (int32_t id = 0; id < kCapacity; ++id) push(&map, id);
  for (int32_t id = 1; id < kCapacity; ++id) add_landmark(&map, {id - 1, id});
  CHECK(least_needed_keyframe(map) == 0);
}

TEST_CASE("the last view of a landmark takes it along unless it is followed") {
  LandmarkMap map = empty_map();
  for (int32_t id = 0; id < kCapacity; ++id) push(&map, id, id != 0);
  const int32_t lost = add_landmark(&map, {0});
  const int32_t followed = add_landmark(&map, {0});
  const int32_t newest = add_landmark(&map, {0, 7});
  map.landmark(followed).followed = true;
  push(&map, 8);
  CHECK(map.landmark(lost).state == LandmarkState::kFree);
  CHECK(map.landmark(followed).state == LandmarkState::kPlaced);
  CHECK(views_of(map, followed).empty());
  CHECK(views_of(map, newest) == std::vector<int32_t>{7});
  CHECK(map.observe(followed, {2, 2}));
  CHECK(views_of(map, followed) == std::vector<int32_t>{8});
}

TEST_CASE("taking out the last view leaves the one before as the last") {
  LandmarkMap map = empty_map();
  for (int32_t id = 0; id < kCapacity; ++id) push(&map, id, id != 2);
  const int32_t slot = add_landmark(&map, {0, 1, 2});
  push(&map, 8);
  CHECK(map.landmark(slot).last.keyframe == 1);
  CHECK(map.observe(slot, {3, 3}));
  CHECK(views_of(map, slot) == std::vector<int32_t>{0, 1, 8});
}

}  // namespace
}  // namespace unisim::geometric
