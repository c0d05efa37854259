// SPDX-License-Identifier: MIT
// The index of places: exact against brute force, what goes when it is full, bad input.
#include "unisim/places.h"

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "tests/support/catch.hpp"

namespace {

using Descriptor = std::vector<int8_t>;

struct Kept {
  int32_t id;
  Descriptor descriptor;
};

int32_t dot(const Descriptor& a, const Descriptor& b) {
  int32_t sum = 0;
  for (size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

class Random {
 public:
  explicit Random(uint32_t seed) : bits_(seed) {}
  Descriptor descriptor(int32_t dimension) {
    Descriptor out;
    for (int32_t k = 0; k < dimension; ++k) {
      out.push_back(static_cast<int8_t>(static_cast<int32_t>(bits_() % 255) - 127));
    }
    return out;
  }
  /// `share` of the numbers replaced: the cosine is about 1 - share.
  Descriptor like(Descriptor of, double share) {
    for (int8_t& value : of) {
      if (static_cast<double>(bits_() % 1000) >= share * 1000) continue;
      value = static_cast<int8_t>(static_cast<int32_t>(bits_() % 255) - 127);
    }
    return of;
  }

 private:
  std::mt19937 bits_;
};

class Index {
 public:
  Index(int32_t capacity, int32_t dimension) {
    REQUIRE(unisim_places_config_init(&config, sizeof config) == UNISIM_OK);
    config.capacity = capacity;
    config.dimension = dimension;
    size_t size = 0;
    REQUIRE(unisim_places_arena_size(&config, &size) == UNISIM_OK);
    arena_.reset(new char[size]);
    REQUIRE(unisim_places_create(&handle, &config, arena_.get(), size) == UNISIM_OK);
  }
  ~Index() { unisim_places_destroy(handle); }
  Index(const Index&) = delete;
  Index& operator=(const Index&) = delete;

  std::vector<unisim_places_match> ask(const Descriptor& descriptor, int32_t id, int32_t gap,
                                       int32_t spread, int32_t most) {
    unisim_places_question question = {};
    question.struct_size = sizeof question;
    question.id = id;
    question.gap = gap;
    question.spread = spread;
    question.descriptor = descriptor.data();
    std::vector<unisim_places_match> out(static_cast<size_t>(most));
    int32_t count = 0;
    REQUIRE(unisim_places_query(handle, &question, out.data(), most, &count) == UNISIM_OK);
    out.resize(static_cast<size_t>(count));
    return out;
  }
  int32_t add(int32_t id, const Descriptor& descriptor) {
    int32_t evicted = -7;
    REQUIRE(unisim_places_add(handle, id, descriptor.data(), &evicted) == UNISIM_OK);
    return evicted;
  }

  unisim_places_config config;
  unisim_places* handle = nullptr;

 private:
  std::unique_ptr<char[]> arena_;
};

std::vector<unisim_places_match> by_sorting(const std::vector<Kept>& all, const Descriptor& asked,
                                            int32_t id, int32_t gap, int32_t spread, size_t most) {
  std::vector<unisim_places_match> sorted;
  for (const Kept& kept : all) sorted.push_back({kept.id, dot(kept.descriptor, asked)});
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return a.score != b.score ? a.score > b.score : a.id < b.id;
  });
  std::vector<unisim_places_match> out;
  for (const auto& match : sorted) {
    const bool apart = std::all_of(out.begin(), out.end(), [&](const auto& taken) {
      return std::abs(taken.id - match.id) >= spread;
    });
    if (apart && std::abs(match.id - id) >= gap && out.size() < most) out.push_back(match);
  }
  return out;
}

}  // namespace

TEST_CASE("the index of places finds what sorting all scores finds") {
  const auto dimension = GENERATE(1, 7, 64, 1024);
  const auto spread = GENERATE(0, 1, 4);
  Random random(5);
  Index index(200, dimension);
  std::vector<Kept> all;
  for (int32_t id = 3; id < 600; id += 3) {
    Kept kept{id, random.descriptor(dimension)};
    if (kept.descriptor == Descriptor(kept.descriptor.size(), 0)) kept.descriptor[0] = 1;
    CHECK(index.add(kept.id, kept.descriptor) == -1);
    all.push_back(kept);
  }
  for (const int32_t gone : {9, 30, 597}) {
    REQUIRE(unisim_places_remove(index.handle, gone) == UNISIM_OK);
    all.erase(std::find_if(all.begin(), all.end(), [&](const Kept& k) { return k.id == gone; }));
  }
  for (const int32_t asked : {0, 300, 700}) {
    const Descriptor descriptor = random.like(all[100].descriptor, 0.5);
    const auto expected = by_sorting(all, descriptor, asked, 20, spread, 10);
    const auto found = index.ask(descriptor, asked, 20, spread, 10);
    REQUIRE(found.size() == expected.size());
    for (size_t k = 0; k < found.size(); ++k) {
      CHECK(found[k].id == expected[k].id);
      CHECK(found[k].score == expected[k].score);
    }
  }
}

TEST_CASE("scores of the longest descriptors do not overflow") {
  Index index(2, 65536);
  index.add(0, Descriptor(65536, 127));
  const auto found = index.ask(Descriptor(65536, -127), 9, 0, 0, 1);
  REQUIRE(found.size() == 1);
  CHECK(found[0].score == -127 * 127 * 65536);
}

TEST_CASE("a full index of places forgets repeated views and never the only one") {
  Random random(11);
  constexpr int32_t kPlaces = 10;
  Index index(kPlaces + 5, 256);
  std::vector<Descriptor> places;
  int32_t id = 0;
  // Each place is passed once; at the third the camera stays for long.
  for (int32_t place = 0; place < kPlaces; ++place) {
    places.push_back(random.descriptor(256));
    const int32_t views = place == 3 ? 200 : 1;
    for (int32_t view = 0; view < views; ++view) {
      const int32_t evicted = index.add(id, random.like(places.back(), 0.2));
      CHECK((evicted == -1 || (evicted >= 3 && evicted < 203)));
      ++id;
    }
  }
  for (const Descriptor& place : places) {
    const auto found = index.ask(place, id, 0, 0, 1);
    REQUIRE(found.size() == 1);
    CHECK(found[0].score > 0.6 * dot(place, place));
  }
}

TEST_CASE("a full index of unlike places refuses a new one and stays as it is") {
  Random random(3);
  Index index(4, 256);
  std::vector<Kept> all;
  for (int32_t id = 0; id < 4; ++id) {
    all.push_back({id, random.descriptor(256)});
    index.add(id, all.back().descriptor);
  }
  const Descriptor other = random.descriptor(256);
  int32_t evicted = -7;
  CHECK(unisim_places_add(index.handle, 4, other.data(), &evicted) == UNISIM_ERR_CAPACITY);
  CHECK(evicted == -7);
  const auto found = index.ask(other, 9, 0, 0, 9);
  CHECK(found.size() == 4);
  // Another view of a place that is kept takes the older one's room, under the refused id too.
  CHECK(index.add(4, random.like(all[2].descriptor, 0.2)) == 2);
}

TEST_CASE("the index of places refuses bad input and stays as it was") {
  Index index(4, 8);
  const Descriptor good(8, 1);
  Descriptor lowest = good;
  lowest[3] = -128;
  index.add(5, good);
  int32_t evicted = 0;
  unisim_places* const places = index.handle;
  CHECK(unisim_places_add(nullptr, 6, good.data(), &evicted) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_add(places, 6, nullptr, &evicted) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_add(places, 5, good.data(), &evicted) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_add(places, -1, good.data(), &evicted) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_add(places, 6, lowest.data(), &evicted) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_add(places, 6, Descriptor(8, 0).data(), &evicted) ==
        UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_remove(places, 6) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_remove(nullptr, 5) == UNISIM_ERR_INVALID_ARGUMENT);

  unisim_places_question question = {};
  question.struct_size = sizeof question;
  question.descriptor = good.data();
  unisim_places_match match = {};
  int32_t count = -7;
  const auto ask = [&] { return unisim_places_query(places, &question, &match, 1, &count); };
  CHECK(unisim_places_query(places, &question, nullptr, 1, &count) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_query(places, &question, &match, 0, &count) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_query(places, &question, &match, 1, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_query(places, nullptr, &match, 1, &count) == UNISIM_ERR_INVALID_ARGUMENT);
  question.gap = -1;
  CHECK(ask() == UNISIM_ERR_INVALID_ARGUMENT);
  question.gap = 0;
  question.spread = -1;
  CHECK(ask() == UNISIM_ERR_INVALID_ARGUMENT);
  question.spread = 0;
  question.descriptor = nullptr;
  CHECK(ask() == UNISIM_ERR_INVALID_ARGUMENT);
  question.descriptor = good.data();
  question.struct_size = 4;
  CHECK(ask() == UNISIM_ERR_ABI_MISMATCH);
  CHECK(count == -7);
  question.struct_size = sizeof question;
  CHECK(ask() == UNISIM_OK);
  CHECK(match.id == 5);
}

TEST_CASE("the configuration of an index of places is checked, its memory is exact") {
  unisim_places_config config;
  CHECK(unisim_places_config_init(nullptr, sizeof config) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_config_init(&config, 4) == UNISIM_ERR_ABI_MISMATCH);
  REQUIRE(unisim_places_config_init(&config, sizeof config) == UNISIM_OK);
  const unisim_places_config good = config;
  size_t size = 0;
  const auto refused = [&] {
    const unisim_status status = unisim_places_arena_size(&config, &size);
    config = good;
    return status == UNISIM_ERR_INVALID_ARGUMENT;
  };
  CHECK((config.capacity = 0, refused()));
  CHECK((config.capacity = 1000001, refused()));
  CHECK((config.dimension = 0, refused()));
  CHECK((config.dimension = 65537, refused()));
  CHECK((config.capacity = 1000000, config.dimension = 65536, refused()));
  CHECK((config.same_place = 1.5, refused()));
  CHECK((config.reserved = 1, refused()));
  REQUIRE(unisim_places_arena_size(&config, &size) == UNISIM_OK);
  std::vector<char> arena(size);
  unisim_places* places = nullptr;
  CHECK(unisim_places_create(&places, &config, arena.data(), size - 1) == UNISIM_ERR_OUT_OF_MEMORY);
  CHECK(unisim_places_create(&places, &config, nullptr, size) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_places_create(nullptr, &config, arena.data(), size) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(places == nullptr);
  REQUIRE(unisim_places_create(&places, &config, arena.data(), size) == UNISIM_OK);
  unisim_places_destroy(places);
  CHECK(unisim_places_remove(places, 0) == UNISIM_ERR_INVALID_ARGUMENT);
  unisim_places_destroy(places);
  unisim_places_destroy(nullptr);
}
