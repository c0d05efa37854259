// SPDX-License-Identifier: MIT
// Which predictions were refused and why.
#include "core/session/refusals.hpp"

namespace unisim {
namespace {

const char* text_of(RefusalReason reason) {
  switch (reason) {
    case RefusalReason::kSigma:
      return "center sigma";
    case RefusalReason::kScatter:
      return "depth ratio scatter";
    case RefusalReason::kViews:
      return "fewer than two views have depth in common with the map";
    case RefusalReason::kRange:
      return "its scale is out of range";
    case RefusalReason::kRoom:
      return "no room for one more window";
    case RefusalReason::kLate:
      return "its keyframes have left the window before it came";
    case RefusalReason::kNone:
    case RefusalReason::kHost:
      break;
  }
  return "rejected by the host";
}

}  // namespace

void Refusals::add(PredictionKind kind, const Refusal& refusal) {
  newest_[index(kind)] = refusal;
  ++counts_[index(kind)];
  if (refusal.reason == RefusalReason::kHost) return;
  LogLine line;
  if (kind == PredictionKind::kPair) {
    line << "pair " << refusal.first_keyframe << "," << refusal.last_keyframe;
  } else {
    line << (kind == PredictionKind::kLoop ? "loop" : "window") << " of keyframes "
         << refusal.first_keyframe << ".." << refusal.last_keyframe;
  }
  line << " refused: " << text_of(refusal.reason);
  if (refusal.limit > 0.0) line << " " << refusal.value << " over " << refusal.limit;
  line.send(log_, LogLevel::kWarning);
}

void Refusals::visit(Archive* archive) {
  for (Refusal& refusal : newest_) {
    archive->choice(&refusal.reason, RefusalReason::kLate);
    archive->value(&refusal.first_keyframe);
    archive->value(&refusal.last_keyframe);
    archive->value(&refusal.value);
    archive->value(&refusal.limit);
  }
  for (Counter& count : counts_) count.visit(archive);
}

}  // namespace unisim
