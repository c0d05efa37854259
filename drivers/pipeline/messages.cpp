// SPDX-License-Identifier: MIT
// Messages of a run.
#include "drivers/pipeline/messages.hpp"

#include "drivers/common/format.hpp"

namespace unisim::pipeline {

std::string request_name(const unisim_request& request) {
  const std::string first = std::to_string(request.keyframe_ids[0]);
  const std::string last = std::to_string(request.keyframe_ids[request.count - 1]);
  return request.kind == UNISIM_REQUEST_PAIR ? "pair " + first + "," + last
                                             : "window of keyframes " + first + ".." + last;
}

std::string refusal_text(const unisim_refusal& refusal) {
  const auto beyond = [&refusal](const char* what) {
    return drivers::format("%s %.3g, over %.3g", what, refusal.value, refusal.limit);
  };
  switch (refusal.reason) {
    case UNISIM_REFUSED_SIGMA:
      return beyond("left out, its poses are uncertain by");
    case UNISIM_REFUSED_SCATTER:
      return beyond("left out, its depths disagree with the map, their ratios scatter by");
    case UNISIM_REFUSED_VIEWS:
      return "left out, fewer than two views have depth in common with the map";
    case UNISIM_REFUSED_RANGE:
      return "left out, its unit is out of the range of numbers";
    default:
      return "left out";
  }
}

void Messages::say(MessageKind kind, const std::string& line) {
  if (++counts_[static_cast<size_t>(kind)] <= kTold) say(line);
}

void Messages::say(const std::string& line) {
  for (Listener* listener : listeners_) listener->on_message(line);
}

void Messages::tell_counts() {
  constexpr std::array<const char*, kKinds> kNames = {"unreadable frames",
                                                      "frames of no use to the predictor",
                                                      "keyframes without an image",
                                                      "rejected pairs",
                                                      "rejected windows",
                                                      "windows taken in part",
                                                      "windows dropped",
                                                      "predictions refused as invalid",
                                                      "windows without ground",
                                                      "optimisations without result"};
  for (size_t kind = 0; kind < kKinds; ++kind) {
    const int64_t more = counts_[kind] - kTold;
    if (more > 0) say("and " + std::to_string(more) + " more " + kNames[kind]);
  }
}

}  // namespace unisim::pipeline
