// SPDX-License-Identifier: MIT
// Hands wide windows to the session and takes those back that a newer one says better.
#include "drivers/pipeline/wide_windows.hpp"

#include <algorithm>
#include <limits>

namespace unisim::pipeline {
namespace {

// Few can end before the middle of the next; the session keeps what is forgotten here.
constexpr size_t kMostKept = 8;
constexpr int32_t kLeastViews = 2;  // of each of two segments
constexpr int32_t kLeastKept = 3;   // views of a window

/// The part of a window that the session still keeps: the predictor may remember longer.
unisim_window_prediction from_keyframe(const unisim_window_prediction& window, int32_t first) {
  const int32_t* end = window.keyframe_ids + window.count;
  const auto gone = std::lower_bound(window.keyframe_ids, end, first) - window.keyframe_ids;
  unisim_window_prediction out = window;
  out.count -= static_cast<int32_t>(gone);
  out.keyframe_ids += gone;
  out.T_window_kf += gone;
  out.depth += gone;
  return out;
}

}  // namespace

WideWindows::WideWindows(SessionClient* session) : session_(session) { kept_.reserve(kMostKept); }

/// Nothing has left the sliding window, and no gap is left out by all windows.
bool WideWindows::revisions_say_all(const unisim_session_info& info) const {
  return info.retired_keyframes == 0 && !gap_;
}

bool WideWindows::wanted() const {
  unisim_session_info info{};
  if (session_->get_info(&info) != UNISIM_OK) return false;
  return info.segments > 1 || !joins_.empty() || !revisions_say_all(info);
}

/// -1 without a pose.
int32_t WideWindows::segment_of(int32_t keyframe_id) const {
  unisim_pose pose{};
  return session_->get_pose(keyframe_id, &pose) == UNISIM_OK ? pose.segment : -1;
}

/// Is the window the first to see two segments? The younger one's keyframes go into `join`.
bool WideWindows::joins(const unisim_window_prediction& window, const unisim_session_info& info,
                        Join* join) const {
  int32_t oldest = std::numeric_limits<int32_t>::max();
  int32_t youngest = -1;
  for (int32_t k = 0; k < window.count; ++k) {
    const int32_t segment = segment_of(window.keyframe_ids[k]);
    if (segment >= 0) oldest = std::min(oldest, segment);
    youngest = std::max(youngest, segment);
  }
  if (youngest <= oldest) return false;
  join->first = -1;
  for (int32_t id = info.first_keyframe; id <= info.last_posed; ++id) {
    if (segment_of(id) != youngest) continue;
    if (join->first < 0) join->first = id;
    join->last = id;
  }
  return true;
}

unisim_status WideWindows::take(const unisim_window_prediction& predicted, bool* taken) {
  *taken = false;
  unisim_session_info info{};
  const unisim_status known = session_->get_info(&info);
  if (known != UNISIM_OK) return known;
  const unisim_window_prediction window = from_keyframe(predicted, info.first_keyframe);
  if (window.count < kLeastKept) return UNISIM_OK;
  Join join{};
  const bool joins_segments = joins(window, info, &join);
  const bool holds =
      joins_segments ||
      std::any_of(joins_.begin(), joins_.end(), [&](const Join& j) { return covers(window, j); });
  if (!holds && revisions_say_all(info)) return UNISIM_OK;
  unisim_window_prediction measured = window;
  // However poor: nothing else ties the two together.
  if (holds) measured.center_sigma = std::min(window.center_sigma, session_->loop_gate());
  int32_t submap_id = -1;
  const unisim_status status = session_->add_loop(measured, &submap_id);
  *taken = status == UNISIM_OK && submap_id >= 0;
  if (status == UNISIM_ERR_RETIRED || status == UNISIM_ERR_CAPACITY ||
      status == UNISIM_ERR_NOT_READY || status == UNISIM_ERR_INVALID_ARGUMENT) {
    return UNISIM_OK;
  }
  if (!*taken) return status;
  unisim_status dropped = drop_outdated(window);
  for (Join& older : joins_) {
    if (!covers(window, older)) continue;
    if (dropped == UNISIM_OK) dropped = remove(older.submap_id);
    older.submap_id = submap_id;
  }
  if (joins_segments) {
    if (joins_.size() == kMostKept) joins_.erase(joins_.begin());
    joins_.push_back({submap_id, join.first, join.last});
  }
  if (holds) return dropped;
  if (kept_.size() == kMostKept) kept_.erase(kept_.begin());
  kept_.push_back({submap_id, window.keyframe_ids[window.count - 1]});
  return dropped;
}

/// Does the window tie the two together as well?
bool WideWindows::covers(const unisim_window_prediction& window, const Join& join) {
  int32_t inside = 0;
  for (int32_t k = 0; k < window.count; ++k) {
    const int32_t id = window.keyframe_ids[k];
    inside += id >= join.first && id <= join.last ? 1 : 0;
  }
  return inside >= kLeastViews && window.count - inside >= kLeastViews;
}

/// It may have left the session's memory by itself.
unisim_status WideWindows::remove(int32_t submap_id) {
  const unisim_status status = session_->remove_loop(submap_id);
  const bool gone = status == UNISIM_ERR_RETIRED || status == UNISIM_ERR_INVALID_ARGUMENT;
  return gone ? UNISIM_OK : status;
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
    const unisim_status status = remove(kept.submap_id);
    if (status != UNISIM_OK) return status;
  }
  kept_.resize(left);
  return UNISIM_OK;
}

}  // namespace unisim::pipeline
