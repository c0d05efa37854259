// SPDX-License-Identifier: MIT
// Parts of the page: its address, series that stay small, the newest of each event.
#include <thread>

#include "tests/support/catch.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/json_text.hpp"
#include "tools/live/web/address.hpp"
#include "tools/live/web/feed.hpp"
#include "tools/live/web/thinned_series.hpp"
#include "tools/live/web/top_view.hpp"

using namespace unisim::live::web;

namespace {

int refusal_of(const std::string& text, bool with_token) {
  try {
    parse_address(text, with_token);
  } catch (const unisim::tools::Failure& failure) {
    return failure.code();
  }
  return 0;
}

/// Data of an event "name".
unisim::tools::Json data_of(const std::string& event) {
  const size_t at = event.find("data: ");
  REQUIRE(at != std::string::npos);
  return unisim::tools::Json::parse(event.substr(at + 6));
}

}  // namespace

TEST_CASE("an address is a port of this machine, or says which one") {
  CHECK(parse_address("8080", false).host == "127.0.0.1");
  CHECK(parse_address("8080", false).port == 8080);
  CHECK(parse_address("[::1]:9", false).host == "::1");
  CHECK(parse_address("0.0.0.0:0", true).host == "0.0.0.0");
  for (const char* wrong : {"", "x", "-1", "65536", ":80", "1.2.3.4:", "80 "}) {
    INFO(wrong);
    CHECK(refusal_of(wrong, true) == unisim::tools::kExitUsage);
  }
}

TEST_CASE("others than this machine are let in with a token only") {
  for (const char* open : {"0.0.0.0:80", "[::]:80", "192.168.1.2:80", "robot:80"}) {
    CHECK(refusal_of(open, false) == unisim::tools::kExitUsage);
    CHECK(refusal_of(open, true) == 0);
  }
}

TEST_CASE("a page of elsewhere that is told to be here is not taken for one of this machine") {
  for (const char* own : {"localhost", "localhost:80", "127.0.0.1:8080", "[::1]:80", "[::1]"}) {
    CHECK(names_this_machine(own));
  }
  for (const char* other : {"", "example.org", "example.org:80", "localhost.example.org"}) {
    CHECK_FALSE(names_this_machine(other));
  }
}

TEST_CASE("a series of any length stays within its capacity and reaches over all of it") {
  ThinnedSeries<int> series(64);
  for (int k = 0; k < 100000; ++k) series.add(k);
  CHECK(series.items().size() <= 64);
  CHECK(series.items().size() >= 32);
  CHECK(series.items().front() == 0);
  CHECK(series.items().back() > 95000);
  const int step = series.items()[1];
  for (size_t k = 0; k < series.items().size(); ++k) {
    CHECK(series.items()[k] == static_cast<int>(k) * step);
  }
}

TEST_CASE("who watches gets the newest and not what it missed") {
  Feed feed("test");
  CHECK_FALSE(feed.watched());
  Feed::Watcher watcher(&feed);
  CHECK(feed.watched());
  constexpr int64_t kLast = 1000;
  View view;
  for (int64_t k = 1; k <= kLast; ++k) {
    view.progress.frames = k;
    feed.offer(&view);
  }
  // The last offer may have met a slot in use: what counts is that it is told when made again.
  size_t events = 0;
  for (int64_t seen = 0; seen != kLast; ++events) {
    view.progress.frames = kLast;
    feed.offer(&view);
    const auto text = watcher.next();
    REQUIRE(text != nullptr);
    if (text->rfind("event: status", 0) == 0) seen = data_of(*text).at("frames").get<int64_t>();
  }
  CHECK(events < kLast / 2);
}

TEST_CASE("closing the feed ends all waits") {
  Feed feed("test");
  Feed::Watcher watcher(&feed);
  std::thread waiting([&watcher] {
    while (watcher.next() != nullptr) continue;
  });
  feed.close();
  waiting.join();
  CHECK(watcher.next() == nullptr);
}

TEST_CASE(
    "from above, down is where the cameras' down is, and the first camera looks up the page") {
  // The world is the first camera, pitched down by 30 degrees: all others likewise.
  constexpr double kHalf = 0.2617993877991494;
  std::vector<PathPoint> path(3);
  for (PathPoint& point : path) {
    point.T_world_cam = {{std::sin(kHalf), 0.0, 0.0, std::cos(kHalf)}, {0.0, 0.0, 0.0}, 1.0};
  }
  TopView top;
  top.fit(path, 0);
  const auto down = transform(path[0].T_world_cam, {0.0, 1.0, 0.0});
  const TopView::Place below = top.place(down);
  CHECK(below.height == Approx(-1.0));
  CHECK(std::abs(below.across) < 1e-9);
  CHECK(std::abs(below.ahead) < 1e-9);
  CHECK(top.place(transform(path[0].T_world_cam, {0.0, 0.0, 1.0})).ahead == Approx(1.0));
  CHECK(top.place({1.0, 0.0, 0.0}).across == Approx(1.0));
}
