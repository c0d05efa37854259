// SPDX-License-Identifier: MIT
// Messages of a run.
#include "drivers/pipeline/messages.hpp"

namespace unisim::pipeline {

void Messages::say(MessageKind kind, const std::string& line) {
  if (++counts_[static_cast<size_t>(kind)] <= kTold) say(line);
}

void Messages::say(const std::string& line) {
  for (Listener* listener : listeners_) listener->on_message(line);
}

void Messages::tell_counts() {
  constexpr std::array<const char*, kKinds> kNames = {"unreadable frames",
                                                      "frames of no use to the predictor",
                                                      "rejected pairs",
                                                      "rejected windows",
                                                      "windows taken in part",
                                                      "predictions refused as invalid",
                                                      "optimisations without result"};
  for (size_t kind = 0; kind < kKinds; ++kind) {
    const int64_t more = counts_[kind] - kTold;
    if (more > 0) say("and " + std::to_string(more) + " more " + kNames[kind]);
  }
}

}  // namespace unisim::pipeline
