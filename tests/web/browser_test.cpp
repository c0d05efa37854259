// SPDX-License-Identifier: MIT
// A browser shows the page of a run: the numbers that it was told, and nothing fails in its script.
#include "tests/support/browser.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"
#include "tools/live/web/server.hpp"

using namespace unisim::live::web;
using namespace unisim::testing;

namespace {

View a_view() {
  View view;
  view.progress.frames = 411;
  view.progress.frames_dropped = 23;
  view.progress.state = UNISIM_STATE_TRACKING;
  view.session.state = UNISIM_STATE_TRACKING;
  view.session.keyframes = 567;
  view.session.submaps = 89;
  view.stages.push_back({"observe", 411, 8.0, 15.5, 99.0});
  view.has_image = true;
  view.pixels.assign(size_t{160} * 120, 90);
  view.image = {view.pixels.data(), 160, 120, 160, UNISIM_PIXEL_GRAY8};
  return view;
}

/// The text of the element with an id.
std::string text_of(const std::string& dom, const std::string& id) {
  const size_t at = dom.find("id=\"" + id + "\"");
  if (at == std::string::npos) return "";
  const size_t begin = dom.find('>', at) + 1;
  return dom.substr(begin, dom.find('<', begin) - begin);
}

}  // namespace

TEST_CASE("a browser shows the numbers of a run") {
  const std::string browser = find_browser();
  if (browser.empty()) {
    WARN("skipped: no chromium");
    return;
  }
  const TempFolder folder;
  Feed feed("test");
  auto server = std::make_unique<Server>(&feed, Address(), "");
  const std::string url = server->url();
  std::atomic<bool> ended{false};
  // A page waits for its stream: the run ends some seconds after somebody has come.
  std::thread run([&] {
    for (int told = 0; told < 60 && !ended;) {
      View view = a_view();
      view.image.data = view.pixels.data();
      told += feed.watched() ? 1 : 0;
      feed.offer(&view);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    server.reset();
  });
  const std::string dom = document_of(browser, url, 2000, folder / "");
  ended = true;
  run.join();
  if (dom.empty()) {
    WARN("skipped: " << browser << " does not start here");
    return;
  }
  CHECK(text_of(dom, "keyframes") == "567");
  CHECK(has(text_of(dom, "keyframes-note"), "89 submaps"));
  CHECK(text_of(dom, "dropped") == "23");
  CHECK(has(text_of(dom, "rate-note"), "411"));
  CHECK_FALSE(has(read_file(folder / "console.log"), "Uncaught"));
}
