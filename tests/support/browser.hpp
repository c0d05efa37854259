// SPDX-License-Identifier: MIT
// A browser without a window, where there is one.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace unisim::testing {

/// Name of its program, "" for none.
inline std::string find_browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    const std::string command = std::string("command -v ") + name + " > /dev/null 2>&1";
    if (std::system(command.c_str()) == 0) return name;
  }
  return "";
}

inline std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen(command.c_str(), "r");
  char part[4096];
  for (size_t got = 0; pipe != nullptr && (got = fread(part, 1, sizeof part, pipe)) > 0;) {
    out.append(part, got);
  }
  if (pipe != nullptr) pclose(pipe);
  return out;
}

/// The document of a page once its script has run for `ms` of its own time; "" where the browser
/// does not start.
/// @param folder for what it keeps, and for console.log, what it has to say
inline std::string document_of(const std::string& browser, const std::string& url, int ms,
                               const std::string& folder) {
  return output_of("timeout 60 " + browser +
                   " --headless=new --no-sandbox --disable-gpu --enable-logging=stderr "
                   "--virtual-time-budget=" +
                   std::to_string(ms) + " --user-data-dir='" + folder + "/profile' --dump-dom '" +
                   url + "' 2> '" + folder + "/console.log'");
}

}  // namespace unisim::testing
