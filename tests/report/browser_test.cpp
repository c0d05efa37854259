// SPDX-License-Identifier: MIT
// A browser opens the page from a file and runs its script.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/catch.hpp"
#include "tools/replay/report/report.hpp"

namespace {

std::string find_browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    const std::string command = std::string("command -v ") + name + " > /dev/null 2>&1";
    if (std::system(command.c_str()) == 0) return name;
  }
  return "";
}

std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen(command.c_str(), "r");
  char part[4096];
  for (size_t got = 0; pipe != nullptr && (got = fread(part, 1, sizeof part, pipe)) > 0;) {
    out.append(part, got);
  }
  if (pipe != nullptr) pclose(pipe);
  return out;
}

}  // namespace

TEST_CASE("a browser runs the script of the page") {
  const std::string browser = find_browser();
  if (browser.empty()) {
    WARN("skipped: no chromium");
    return;
  }
  std::string folder = (std::filesystem::temp_directory_path() / "unisim-report-XXXXXX").string();
  REQUIRE(mkdtemp(folder.data()) != nullptr);
  unisim::report::ReportData data;
  data.title = "page";
  for (int k = 0; k < 9; ++k) data.estimate.push_back({1.0 * k, 1.0 * k, 0.1 * k * k, 0.0, 0});
  std::ofstream(folder + "/page.html") << unisim::report::report_html(data);
  const std::string dom = output_of(
      "timeout 60 " + browser +
      " --headless=new --no-sandbox --disable-gpu --virtual-time-budget=500 --user-data-dir='" +
      folder + "/profile' --dump-dom 'file://" + folder + "/page.html' 2> /dev/null");
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
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
