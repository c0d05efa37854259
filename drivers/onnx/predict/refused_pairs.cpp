// SPDX-License-Identifier: MIT
// Which views of a refused window are to blame.
#include "drivers/onnx/predict/refused_pairs.hpp"

namespace unisim::onnx {

void RefusedPairs::settle(int32_t j, bool refused) {
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_ = j;
  refused_[static_cast<size_t>(j) % refused_.size()] = refused ? 1 : 0;
}

bool RefusedPairs::pair_refused(int32_t j) const {
  const auto kept = static_cast<int32_t>(refused_.size());
  if (j < 1 || j > newest_ || j <= newest_ - kept) return false;
  return refused_[static_cast<size_t>(j) % refused_.size()] != 0;
}

bool RefusedPairs::blamed(int32_t keyframe, Blame blame, int32_t newest) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool before = pair_refused(keyframe);
  const bool after = keyframe < newest && pair_refused(keyframe + 1);
  if (blame == Blame::kBothPairs) return before && after;
  return blame == Blame::kFirst ? after : before;
}

}  // namespace unisim::onnx
