// SPDX-License-Identifier: MIT
// Hands wide windows to the session and takes those back that a newer one says better.
#include "drivers/pipeline/wide_windows.hpp"

namespace unisim::pipeline {
namespace {

// Few can end before the middle of the next; the session keeps what is forgotten here.
constexpr size_t kMostKept = 8;

}  // namespace

WideWindows::WideWindows(SessionClient* session) : session_(session) { kept_.reserve(kMostKept); }

bool WideWindows::wanted() const {
  unisim_session_info info{};
  return session_->get_info(&info) == UNISIM_OK && info.retired_keyframes > 0;
}

unisim_status WideWindows::take(const unisim_window_prediction& window, bool* taken) {
  *taken = false;
  int32_t submap_id = -1;
  const unisim_status status = session_->add_loop(window, &submap_id);
  *taken = status == UNISIM_OK && submap_id >= 0;
  if (status == UNISIM_ERR_RETIRED || status == UNISIM_ERR_CAPACITY ||
      status == UNISIM_ERR_NOT_READY || status == UNISIM_ERR_INVALID_ARGUMENT) {
    return UNISIM_OK;
  }
  if (!*taken) return status;
  const unisim_status dropped = drop_outdated(window);
  if (kept_.size() == kMostKept) kept_.erase(kept_.begin());
  kept_.push_back({submap_id, window.keyframe_ids[window.count - 1]});
  return dropped;
}

unisim_status WideWindows::drop_outdated(const unisim_window_prediction& newest) {
  const int32_t first = newest.keyframe_ids[0];
  const int32_t middle = first + (newest.keyframe_ids[newest.count - 1] - first) / 2;
  size_t left = 0;
  for (const Kept& kept : kept_) {
    if (kept.last_keyframe <= middle) {
      kept_[left++] = kept;
      continue;
    }
    const unisim_status status = session_->remove_loop(kept.submap_id);
    // It may have left the session's memory by itself.
    const bool gone = status == UNISIM_ERR_RETIRED || status == UNISIM_ERR_INVALID_ARGUMENT;
    if (status != UNISIM_OK && !gone) return status;
  }
  kept_.resize(left);
  return UNISIM_OK;
}

}  // namespace unisim::pipeline
