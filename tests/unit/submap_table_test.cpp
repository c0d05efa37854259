// SPDX-License-Identifier: MIT
// The table of submaps: found by id however many have been erased.
#include "core/map/submap_table.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

namespace {

struct TableFixture {
  std::vector<unsigned char> memory = std::vector<unsigned char>(65536);
  Arena arena{memory.data(), memory.size()};
  SubmapTable table{arena, {4, 2, 3, 5, 8}};
};

}  // namespace

TEST_CASE("submaps are found by id after others were erased") {
  TableFixture f;
  for (int32_t id = 0; id < 20; ++id) {
    REQUIRE(f.table.has_room(false));
    REQUIRE(f.table.append(false, 2) == id);
    f.table[id].window.first = 10 * id;
    f.table.release_views(&f.table[id]);
    if (id >= 3) f.table.erase(f.table.at(id % 2).id);
  }
  int32_t found = 0;
  for (int32_t id = 0; id < 20; ++id) {
    CHECK(f.table.has(id) != f.table.gone(id));
    if (!f.table.has(id)) continue;
    ++found;
    CHECK(f.table[id].id == id);
    CHECK(f.table[id].window.first == 10 * id);
  }
  CHECK(found == f.table.size());
  CHECK_FALSE(f.table.has(20));
  CHECK_FALSE(f.table.gone(20));
}

TEST_CASE("windows, loops and views have room of their own") {
  TableFixture f;
  f.table.append(true, 5);
  f.table.append(true, 5);
  CHECK_FALSE(f.table.has_room(true));
  CHECK(f.table.has_room(false));
  f.table.append(false, 5);
  CHECK_FALSE(f.table.has_room(false));
  f.table.release_views(&f.table[0]);
  CHECK(f.table.has_room(false));
}

TEST_CASE("keyframes of a submap stay known when its views are given back") {
  TableFixture f;
  const int32_t id = f.table.append(false, 2);
  f.table.set_keyframe(f.table[id], 0, 7);
  f.table.set_keyframe(f.table[id], 1, 9);
  CHECK(f.table.view(f.table[id], 1).keyframe == 9);
  f.table.release_views(&f.table[id]);
  CHECK(f.table.keyframe(f.table[id], 0) == 7);
  CHECK(f.table.keyframe(f.table[id], 1) == 9);
}

TEST_CASE("the id of a submap taken back is used again") {
  TableFixture f;
  f.table.append(false, 2);
  CHECK(f.table.append(true, 2) == 1);
  f.table.remove_last();
  CHECK_FALSE(f.table.gone(1));
  CHECK(f.table.append(false, 2) == 1);
  CHECK_FALSE(f.table[1].is_loop);
}

TEST_CASE("what a submap shares is forgotten with it") {
  TableFixture f;
  REQUIRE(f.table.add_shared({0, 1, 0, 0, 0.0, -1, -1}));
  REQUIRE(f.table.add_shared({1, 2, 0, 0, 0.0, -1, -1}));
  REQUIRE(f.table.add_shared({2, 3, 0, 0, 0.0, -1, -1}));
  f.table.drop_shared(1);
  REQUIRE(f.table.shared().size() == 1);
  CHECK(f.table.shared()[0].m == 2);
}
