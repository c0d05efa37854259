// SPDX-License-Identifier: MIT
// What the system says of a live run.
#include "tools/live/figures.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace unisim::live {

double FrameRate::update(int64_t frames) {
  const std::chrono::duration<double> passed = Clock::now() - since_;
  if (passed.count() >= 1.0) {
    per_second_ = static_cast<double>(frames - frames_then_) / passed.count();
    frames_then_ = frames;
    since_ = Clock::now();
  }
  return per_second_;
}

int64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  int64_t total = 0;
  int64_t resident = 0;
  file >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

double temperature_c(const std::string& folder) {
  double warmest = -1.0;
  std::error_code error;
  for (const auto& zone : std::filesystem::directory_iterator(folder, error)) {
    std::ifstream file(zone.path() / "temp");
    double thousandths = 0.0;
    if (file >> thousandths) warmest = std::max(warmest, thousandths / 1000.0);
  }
  return warmest;
}

}  // namespace unisim::live
