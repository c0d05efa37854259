// SPDX-License-Identifier: MIT
// Held keyframes: found by id, dropped in any order, slots used again.
#include "drivers/geometric/map/keyframe_slots.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>

namespace unisim::geometric {
namespace {

TEST_CASE("slots are found by id while keyframes come and go") {
  constexpr int32_t kCapacity = 37;
  KeyframeSlots slots(kCapacity);
  std::map<int32_t, int32_t> held;
  std::mt19937 random(5);
  int32_t id = 0;
  for (int round = 0; round < 5000; ++round) {
    if (slots.full()) {
      auto gone = held.begin();
      std::advance(gone, static_cast<std::ptrdiff_t>(random() % held.size()));
      slots.drop(gone->first);
      CHECK(slots.find(gone->first) == KeyframeSlots::kNone);
      held.erase(gone);
    }
    id += 1 + static_cast<int32_t>(random() % 70);
    held[id] = slots.take(id);
    std::vector<int32_t> used;
    for (const auto& [known, slot] : held) {
      if (slots.find(known) != slot) FAIL("keyframe " << known << " is in another slot");
      used.push_back(slot);
    }
    std::sort(used.begin(), used.end());
    REQUIRE(std::adjacent_find(used.begin(), used.end()) == used.end());
    REQUIRE((used.front() >= 0 && used.back() < kCapacity));
    REQUIRE(std::equal(held.begin(), held.end(), slots.ids().begin(), slots.ids().end(),
                       [](const auto& entry, int32_t listed) { return entry.first == listed; }));
    CHECK(slots.find(id + 1) == KeyframeSlots::kNone);
  }
}

}  // namespace
}  // namespace unisim::geometric
