// SPDX-License-Identifier: MIT
// Windows of a saved map are asked for again, so that what is measured better reaches their
// submaps.
#include "drivers/pipeline/window_book.hpp"

#include <set>
#include <vector>

#include "drivers/pipeline/map_saving.hpp"
#include "tests/pipeline/scripted_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;
using unisim::mapfile::Bytes;
using unisim::pipeline::WindowBook;

namespace {

/// Gives every window it is asked for, but for keyframe `without`.
struct WindowPredictor {
  unisim_predictor table{};  // first
  int32_t without = -1;
  int64_t next_token = 100;
  std::vector<int32_t> given;

  WindowPredictor() {
    table.multi_view = [](unisim_predictor* p, const int32_t* ids, int32_t count,
                          unisim_window_prediction* out) {
      auto* const me = reinterpret_cast<WindowPredictor*>(p);
      me->given.clear();
      for (int32_t k = 0; k < count; ++k) {
        if (ids[k] != me->without) me->given.push_back(ids[k]);
      }
      if (me->given.size() < 2) return UNISIM_PREDICTION_REJECTED;
      *out = {};
      out->keyframe_ids = me->given.data();
      out->count = static_cast<int32_t>(me->given.size());
      out->token = me->next_token++;
      return UNISIM_PREDICTION_OK;
    };
  }
};

void add_window(std::vector<int32_t> ids, int64_t token, int32_t submap, WindowBook* book) {
  unisim_window_prediction window{};
  window.keyframe_ids = ids.data();
  window.count = static_cast<int32_t>(ids.size());
  window.token = token;
  book->add(window, submap);
}

/// Three windows, of which the book has room for two.
Bytes saved() {
  WindowBook book(2);
  add_window({0, 1, 2}, 0, 7, &book);
  add_window({2, 3, 4}, 1, 8, &book);
  add_window({4, 5}, 2, 9, &book);
  return book.bytes();
}

}  // namespace

TEST_CASE("the newest windows are known by their tokens") {
  WindowBook book(2);
  add_window({0, 1, 2}, 5, 7, &book);
  CHECK(book.submap_of(5) == 7);
  add_window({2, 3, 4}, 6, 8, &book);
  add_window({4, 5}, 7, 9, &book);
  CHECK(book.submap_of(5) == -1);
  CHECK(book.submap_of(6) == 8);
  CHECK(book.submap_of(7) == 9);
}

TEST_CASE("windows of a loaded map are known by the tokens that they get anew") {
  WindowPredictor predictor;
  WindowBook book(8);
  book.load(saved(), "room.map", 6, &predictor.table);
  CHECK(book.submap_of(100) == 8);
  CHECK(book.submap_of(101) == 9);
  CHECK(book.bytes() == saved());
}

TEST_CASE("a window that the predictor no longer has whole stays as it is") {
  WindowPredictor predictor;
  predictor.without = 3;
  WindowBook book(8);
  book.load(saved(), "room.map", 6, &predictor.table);
  CHECK(book.submap_of(100) == -1);
  CHECK(book.submap_of(101) == 9);
}

TEST_CASE("windows of a map that are none are refused by name") {
  WindowPredictor predictor;
  WindowBook book(8);
  const Bytes whole = saved();
  const auto why = [&](const Bytes& bytes, int32_t keyframes) {
    try {
      book.load(bytes, "room.map", keyframes, &predictor.table);
    } catch (const unisim::mapfile::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(has(why(whole, 5), "room.map: part windows"));  // keyframe 5 is not there
  for (size_t size = 1; size < whole.size(); ++size) {
    const std::string problem = why({whole.begin(), whole.begin() + static_cast<long>(size)}, 6);
    INFO(size);
    // The first window by itself is whole.
    CHECK((has(problem, "part windows") || size == 20));
  }
  for (size_t at = 0; at < whole.size(); ++at) {
    Bytes flipped = whole;
    flipped[at] ^= 0x80;
    static_cast<void>(why(flipped, 6));  // refused or other windows: nothing is read past its end
  }
}

TEST_CASE("submaps of a map that is gone on with take better measurements") {
  const TempFolder folder;
  const std::string path = folder / "first.map";
  Run first;
  first.predictor.revises = false;
  REQUIRE(first.go().outcome == Outcome::kFinished);
  const int32_t submaps = first.info().submaps;
  REQUIRE(submaps > 2);
  unisim::pipeline::save_map(path, {}, *first.pipeline, first.predictor.table());

  struct Revised : Listener {
    std::set<int32_t> submaps;
    void on_revision(int32_t submap_id, const unisim_window_revision&) override {
      submaps.insert(submap_id);
    }
  } revised;
  Run second(20);
  second.listeners.push_back(&revised);
  second.predictor.revises = true;
  second.pipeline =
      std::make_unique<Pipeline>(second.options, second.source.table(), second.predictor.table(),
                                 second.config, second.listeners, &second.stop);
  unisim::mapfile::MapFile map(path);
  second.pipeline->load(&map);
  REQUIRE(second.pipeline->run().outcome == Outcome::kFinished);
  for (int32_t id = 0; id < submaps; ++id) CHECK(revised.submaps.count(id) == 1);
}
