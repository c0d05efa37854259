// SPDX-License-Identifier: MIT
// Messages of a run: the first few of each kind in full, the others as a count at the end.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "unisim/unisim.h"

namespace unisim::pipeline {

enum class MessageKind {
  kBadFrame,
  kUselessFrame,
  kWithoutPixels,
  kPairRejected,
  kWindowRejected,
  kWindowReduced,
  kWindowDropped,
  kInvalid,
  kNoGround,
  kSolver
};

/// "pair 3,4" or "window of keyframes 0..15".
std::string request_name(const unisim_request& request);

/// Why the session left a prediction out, to stand after its name.
std::string refusal_text(const unisim_refusal& refusal);

class Messages {
 public:
  explicit Messages(const std::vector<Listener*>& listeners) : listeners_(listeners) {}

  /// Passes the line on, or counts it once five of its kind have been told.
  void say(MessageKind kind, const std::string& line);

  /// Passes a line on whatever came before.
  void say(const std::string& line);

  /// Tells how many lines of each kind were only counted.
  void tell_counts();

  /// Lines of one kind, told and counted.
  int64_t count(MessageKind kind) const { return counts_[static_cast<size_t>(kind)]; }

 private:
  static constexpr int64_t kTold = 5;
  static constexpr size_t kKinds = 10;

  const std::vector<Listener*>& listeners_;
  std::array<int64_t, kKinds> counts_{};
};

}  // namespace unisim::pipeline
