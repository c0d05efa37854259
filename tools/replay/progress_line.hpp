// SPDX-License-Identifier: MIT
// Progress and messages of a run: a bar on a terminal, lines elsewhere, JSON on request.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/pipeline/listener.hpp"

namespace unisim::replay {

/// Name of a UNISIM_STATE_*.
const char* state_name(int32_t state);
/// The state, and the reason for it where there is one: "lost (covered)".
std::string state_text(const pipeline::Progress& progress);

class ProgressLine : public pipeline::Listener {
 public:
  enum class Style {
    kNone,      ///< messages only
    kTerminal,  ///< one line on stderr, rewritten ten times a second
    kLines,     ///< a line on stderr every five seconds
    kJson,      ///< objects on stdout, one a second
  };

  /// What the line says, but for kJson.
  using Text = std::function<std::string(const pipeline::Progress&)>;

  /// @param text empty: frames, rate, map, state and how long it may take
  explicit ProgressLine(Style style, Text text = {}) : style_(style), text_(std::move(text)) {}

  void on_progress(const pipeline::Progress& progress) override;
  void on_message(const std::string& line) override;

  /// The lines told so far; the pipeline bounds their number.
  const std::vector<std::string>& messages() const { return messages_; }

  /// Shows the last state and ends the line of a terminal.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  bool due();
  void print_line(const pipeline::Progress& progress) const;
  std::string usual_text(const pipeline::Progress& progress) const;
  void print_json(const pipeline::Progress& progress) const;
  double seconds() const;
  void end_line();

  Style style_;
  Text text_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
  pipeline::Progress last_;
  bool line_open_ = false;
  std::vector<std::string> messages_;
};

}  // namespace unisim::replay
