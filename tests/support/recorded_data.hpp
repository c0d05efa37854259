// SPDX-License-Identifier: MIT
// Where the recorded sequences are that some tests use.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

/// Path of a recording, "" when it is absent: then the test says so and returns.
inline std::string recorded_data(const std::string& name) {
  const char* root = std::getenv("UNISIM_DATA");
  const std::string path = std::string(root != nullptr ? root : UNISIM_DATA) + "/" + name;
  return std::filesystem::exists(path) ? path : "";
}

#define UNISIM_SKIP_WITHOUT(path)                        \
  if ((path).empty()) {                                  \
    WARN("skipped: no recorded data (set UNISIM_DATA)"); \
    return;                                              \
  }
