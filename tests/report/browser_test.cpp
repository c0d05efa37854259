// SPDX-License-Identifier: MIT
// A browser opens the page from a file and runs its script.
#include "tests/support/browser.hpp"

#include <string>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/replay/report/report.hpp"

using namespace unisim::testing;

TEST_CASE("a browser runs the script of the page") {
  const std::string browser = find_browser();
  if (browser.empty()) {
    WARN("skipped: no chromium");
    return;
  }
  const TempFolder folder;
  unisim::report::ReportData data;
  data.title = "page";
  for (int k = 0; k < 9; ++k) data.estimate.push_back({1.0 * k, 1.0 * k, 0.1 * k * k, 0.0, 0});
  const std::string page = folder.write("page.html", unisim::report::report_html(data));
  const std::string dom = document_of(browser, "file://" + page, 500, folder.path());
  if (dom.empty()) {
    WARN("skipped: " << browser << " does not start here");
    return;
  }
  // The script hangs a cursor into each of the three charts.
  size_t cursors = 0;
  for (size_t at = dom.find("class=\"cursor\""); at != std::string::npos;
       at = dom.find("class=\"cursor\"", at + 1)) {
    ++cursors;
  }
  CHECK(cursors == 3);
}
