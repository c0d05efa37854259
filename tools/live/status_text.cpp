// SPDX-License-Identifier: MIT
// The status line of a live run.
#include "tools/live/status_text.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "tools/common/text.hpp"
#include "tools/replay/progress_line.hpp"

namespace unisim::live {
namespace {

/// Memory the process holds now.
int64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  int64_t total = 0;
  int64_t resident = 0;
  file >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace

/// Over the last second or so.
double StatusText::rate(int64_t frames) {
  const std::chrono::duration<double> passed = Clock::now() - rate_since_;
  if (passed.count() >= 1.0) {
    frames_per_second_ = static_cast<double>(frames - frames_then_) / passed.count();
    frames_then_ = frames;
    rate_since_ = Clock::now();
  }
  return frames_per_second_;
}

std::string StatusText::operator()(const pipeline::Progress& progress) {
  constexpr double kMega = 1e6;
  std::string text = tools::format(
      "%s, %.0f frames/s, pose age %.0f ms (p95 %.0f), %lld dropped, %d keyframes, %d submaps, "
      "%.0f MB",
      replay::state_name(progress.state), rate(progress.frames), ages_->ages().percentile_ms(0.5),
      ages_->ages().percentile_ms(0.95), static_cast<long long>(progress.frames_dropped),
      progress.keyframes, progress.submaps, static_cast<double>(resident_bytes()) / kMega);
  const double warmest = temperature_c();
  if (warmest >= 0.0) text += tools::format(", %.0f C", warmest);
  return text;
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
