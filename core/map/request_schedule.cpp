// SPDX-License-Identifier: MIT
// Which predictions a session wants next.
#include "core/map/request_schedule.hpp"

#include <algorithm>

namespace unisim {

/// The newest settled keyframe does not know its unit yet where that comes with the next pair,
/// unless the host has said that none will come.
int32_t RequestSchedule::settled_for_windows() const {
  const int32_t settled = keyframes_.settled();
  if (!unit_by_next_) return settled;
  return std::max(settled - 1, std::min(settled, closed_at_ - 1));
}

Status RequestSchedule::next(uint32_t kinds, Request* request) const {
  // A window's keyframes are all settled and an open pair's are not, so the window is the older
  // one.
  const Window* window = windows_.oldest(settled_for_windows());
  if ((kinds & kRequestWindow) != 0 && window != nullptr) {
    *request = {kRequestWindow, *window};
    return Status::kOk;
  }
  if ((kinds & kRequestPair) != 0 && keyframes_.settled() + 1 < keyframes_.size()) {
    *request = {kRequestPair, {keyframes_.settled(), 2}};
    return Status::kOk;
  }
  return Status::kNotReady;
}

bool RequestSchedule::wants(const Request& request) const {
  const Window& asked = request.keyframes;
  if (request.kind == kRequestPair) {
    return asked.first == keyframes_.settled() && asked.count == 2 &&
           asked.last() < keyframes_.size();
  }
  int32_t index = -1;
  if (request.kind != kRequestWindow) return false;
  if (!is_ok(find_window(asked.first, asked.last(), &index))) return false;
  return windows_.at(index).first == asked.first && windows_.at(index).count == asked.count;
}

Status RequestSchedule::find_window(int32_t first, int32_t last, int32_t* index) const {
  *index = windows_.find(first, last);
  if (*index < 0) return Status::kInvalidArgument;
  return windows_.at(*index).last() <= settled_for_windows() ? Status::kOk : Status::kNotReady;
}

Window RequestSchedule::take_window(int32_t index) {
  const Window window = windows_.at(index);
  windows_.remove(index);
  return window;
}

Status RequestSchedule::close_window() {
  const bool waiting = windows_.oldest(settled_for_windows()) != nullptr;
  closed_at_ = keyframes_.size();
  if (windows_.close(keyframes_.size())) return Status::kOk;
  // A full window that was held back for the pair after it may be asked for now.
  const bool released = !waiting && windows_.oldest(settled_for_windows()) != nullptr;
  return released ? Status::kOk : Status::kNotReady;
}

}  // namespace unisim
