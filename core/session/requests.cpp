// SPDX-License-Identifier: MIT
// Which predictions the session wants.
#include <algorithm>

#include "core/session.hpp"

namespace unisim {

int32_t Session::settled_for_windows() const {
  if (config_.preset == Preset::kConsistent) return settled_;
  // The unit of a keyframe is that of the pair after it, which the newest keyframe does not have
  // yet.
  return std::max(settled_ - 1, std::min(settled_, closed_at_ - 1));
}

Status Session::next_request(uint32_t kinds, Request* request) const {
  // A window's keyframes are all settled and an open pair's are not, so the window is the older
  // one.
  const Window* window = windows_.oldest(settled_for_windows());
  if ((kinds & kRequestWindow) != 0 && window != nullptr) {
    *request = {kRequestWindow, *window};
    return Status::kOk;
  }
  if ((kinds & kRequestPair) != 0 && settled_ + 1 < keyframes_.size()) {
    *request = {kRequestPair, {settled_, 2}};
    return Status::kOk;
  }
  return Status::kNotReady;
}

Status Session::reject_request(const Request& request) {
  const Window& window = request.keyframes;
  if (request.kind == kRequestPair) {
    const bool open =
        window.first == settled_ && window.count == 2 && window.last() < keyframes_.size();
    if (!open) return Status::kInvalidArgument;
    refuse_pair(window.last(), RefusalReason::kHost);
    return Status::kOk;
  }
  if (request.kind != kRequestWindow) return Status::kInvalidArgument;
  const int32_t index = windows_.find(window.first, window.last());
  const bool open = index >= 0 && windows_.at(index).first == window.first &&
                    windows_.at(index).count == window.count &&
                    window.last() <= settled_for_windows();
  if (!open) return Status::kInvalidArgument;
  windows_.remove(index);
  refuse_window(window, RefusalReason::kHost);
  return Status::kOk;
}

Status Session::close_window() {
  const bool waiting = windows_.oldest(settled_for_windows()) != nullptr;
  closed_at_ = keyframes_.size();
  if (windows_.close(keyframes_.size())) return Status::kOk;
  // The paper's preset holds a full window back until the pair after it; now none will come.
  const bool released = !waiting && windows_.oldest(settled_for_windows()) != nullptr;
  return released ? Status::kOk : Status::kNotReady;
}

}  // namespace unisim
