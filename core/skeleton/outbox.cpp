// SPDX-License-Identifier: MIT
// What leaves the window is offered once, in order, to whoever keeps it.
#include "core/skeleton/outbox.hpp"

#include <algorithm>

namespace unisim {

void Outbox::lose_through(const KeyframeRing& keyframes, int32_t last) {
  for (int32_t id = std::max(offered_, keyframes.first()); id <= last; ++id) {
    if (keyframes.pose_source(id) >= 0) ++unread_;
  }
  offered_ = std::max(offered_, last + 1);
}

Status Outbox::next(const KeyframeRing& keyframes, int32_t end, Retired* retired) {
  for (offered_ = std::max(offered_, keyframes.first()); offered_ < end; ++offered_) {
    const int32_t source = keyframes.pose_source(offered_);
    if (source < 0 || !keyframes[source].retired()) continue;
    const Keyframe& keyframe = keyframes[offered_];
    const Keyframe& carried = keyframes[source];
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
  const int32_t kept = std::min(made_ - read_, merges_.size());
  unread_ += made_ - read_ - kept;
  read_ = made_ - kept;
  if (kept == 0) return Status::kNotReady;
  *retired = merges_[read_++ % merges_.size()];
  return Status::kOk;
}

}  // namespace unisim
