// SPDX-License-Identifier: MIT
// Progress and messages of a run.
#include "tools/replay/progress_line.hpp"

#include <algorithm>
#include <iostream>

#include "drivers/common/format.hpp"
#include "drivers/pipeline/tracking_reason.hpp"
#include "tools/common/json_text.hpp"
#include "tools/common/output.hpp"
#include "tools/common/text.hpp"

namespace unisim::replay {
namespace {

constexpr int kBarWidth = 24;

std::string bar(double share) {
  const int full = static_cast<int>(share * kBarWidth);
  return "[" + std::string(static_cast<size_t>(full), '=') +
         std::string(static_cast<size_t>(kBarWidth - full), ' ') + "] ";
}

}  // namespace

const char* state_name(int32_t state) {
  switch (state) {
    case UNISIM_STATE_INIT:
      return "init";
    case UNISIM_STATE_TRACKING:
      return "tracking";
    case UNISIM_STATE_DEGRADED:
      return "degraded";
    case UNISIM_STATE_LOST:
      return "lost";
    case UNISIM_STATE_RELOCALISED:
      return "relocalised";
    default:
      return "unknown";
  }
}

std::string state_text(const pipeline::Progress& progress) {
  const std::string state = state_name(progress.state);
  const std::string reason = pipeline::reason_name(progress.reason);
  return reason.empty() ? state : state + " (" + reason + ")";
}

double ProgressLine::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

bool ProgressLine::due() {
  if (style_ == Style::kNone || Clock::now() < next_) return false;
  const int period_ms = style_ == Style::kTerminal ? 100 : style_ == Style::kJson ? 1000 : 5000;
  next_ = Clock::now() + std::chrono::milliseconds(period_ms);
  return true;
}

void ProgressLine::on_progress(const pipeline::Progress& progress) {
  last_ = progress;
  if (!due()) return;
  if (style_ == Style::kJson) return print_json(progress);
  print_line(progress);
  line_open_ = style_ == Style::kTerminal;
}

void ProgressLine::print_line(const pipeline::Progress& progress) const {
  const std::string text = text_ ? text_(progress) : usual_text(progress);
  if (style_ == Style::kTerminal)
    std::cerr << "\r\x1b[K" << text << std::flush;
  else
    std::cerr << text << "\n";
}

std::string ProgressLine::usual_text(const pipeline::Progress& progress) const {
  const double fps = static_cast<double>(progress.frames) / std::max(seconds(), 1e-3);
  std::string text;
  const int64_t done = progress.frames + progress.frames_bad + progress.frames_dropped;
  if (progress.frames_total > 0) {
    text =
        bar(std::min(1.0, static_cast<double>(done) / static_cast<double>(progress.frames_total)));
  }
  text += drivers::format("%lld frames, %.0f/s, %d keyframes, %d submaps, %s",
                          static_cast<long long>(progress.frames), fps, progress.keyframes,
                          progress.submaps, state_text(progress).c_str());
  if (progress.frames_total > done && fps > 0.0) {
    text +=
        drivers::format(", %.0f s left", static_cast<double>(progress.frames_total - done) / fps);
  }
  return text;
}

void ProgressLine::print_json(const pipeline::Progress& progress) const {
  const tools::Json line = {{"type", "progress"},
                            {"frames", progress.frames},
                            {"frames_total", progress.frames_total},
                            {"frames_bad", progress.frames_bad},
                            {"frames_dropped", progress.frames_dropped},
                            {"keyframes", progress.keyframes},
                            {"submaps", progress.submaps},
                            {"state", state_name(progress.state)},
                            {"reason", pipeline::reason_name(progress.reason)},
                            {"seconds", seconds()}};
  tools::print(tools::json_text(line) + "\n");
}

void ProgressLine::on_message(const std::string& line) {
  messages_.push_back(line);
  if (style_ == Style::kJson) {
    tools::print(tools::json_text({{"type", "message"}, {"text", line}}) + "\n");
    return;
  }
  end_line();
  std::cerr << tools::one_line(line) << "\n";
}

void ProgressLine::finish() {
  if (line_open_) print_line(last_);
  end_line();
}

void ProgressLine::end_line() {
  if (line_open_) std::cerr << "\n";
  line_open_ = false;
}

}  // namespace unisim::replay
