// SPDX-License-Identifier: MIT
// The status line of a live run.
#include "tools/live/status_text.hpp"

#include "drivers/common/format.hpp"
#include "tools/replay/progress_line.hpp"

namespace unisim::live {

std::string StatusText::operator()(const pipeline::Progress& progress) {
  constexpr double kMega = 1e6;
  std::string text = drivers::format(
      "%s, %.0f frames/s, pose age %.0f ms (p95 %.0f), %d waiting, %lld dropped, %d keyframes, "
      "%d submaps, %d loops, %.0f MB",
      replay::state_text(progress).c_str(), rate_.update(progress.frames),
      ages_->ages().percentile_ms(0.5), ages_->ages().percentile_ms(0.95), progress.frames_waiting,
      static_cast<long long>(progress.frames_dropped), progress.keyframes, progress.submaps,
      progress.loops, static_cast<double>(resident_bytes()) / kMega);
  if (progress.metre.per_unit > 0.0) {
    text += drivers::format(", metric +- %.2g %% (1 unit = %.3g m)", 100.0 * progress.metre.sigma,
                            progress.metre.per_unit);
  } else {
    text += ", relative";
  }
  const double warmest = temperature_c();
  if (warmest >= 0.0) text += drivers::format(", %.0f C", warmest);
  return text;
}

std::string age_text(const pipeline::LatencyHistogram& ages) {
  return drivers::format(
      "%lld poses, from the stamp of the frame to the pose p50 %.1f, p95 %.1f, p99 %.1f, max %.1f "
      "ms",
      static_cast<long long>(ages.count()), ages.percentile_ms(0.5), ages.percentile_ms(0.95),
      ages.percentile_ms(0.99), ages.max_ms());
}

}  // namespace unisim::live
