// SPDX-License-Identifier: MIT
// What leaves the window is offered once, in order, to whoever keeps it.
#include <algorithm>

#include "core/session.hpp"

namespace unisim {

Status Session::next_retired(Retired* retired) {
  if (!slides()) return Status::kNotReady;
  for (offered_ = std::max(offered_, keyframes_.first()); offered_ < live_from_; ++offered_) {
    const int32_t source = keyframes_.pose_source(offered_);
    if (source < 0 || !keyframes_[source].retired()) continue;
    const Keyframe& keyframe = keyframes_[offered_];
    const Keyframe& carried = keyframes_[source];
    *retired = Retired();
    retired->keyframe = offered_;
    retired->timestamp_ns = keyframe.timestamp_ns;
    retired->submap = carried.owner;
    retired->T = carried.T_owner_kf;
    retired->confidence = keyframe.confidence();
    retired->segment = keyframe.segment;
    ++offered_;
    return Status::kOk;
  }
  const int32_t kept = std::min(merges_made_ - merges_offered_, merges_.size());
  counts_.retired_unread += merges_made_ - merges_offered_ - kept;
  merges_offered_ = merges_made_ - kept;
  if (kept == 0) return Status::kNotReady;
  *retired = merges_[merges_offered_++ % merges_.size()];
  return Status::kOk;
}

}  // namespace unisim
