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

/// Those that wait are numbered from 0 on again.
void Outbox::visit(Archive* archive, const KeyframeRing& keyframes, int32_t next_submap) {
  const int32_t slots = merges_.size();
  archive->index(&offered_, 0, keyframes.size());
  archive->index(&unread_, 0, kMostCount);
  int32_t made = made_ - read_;
  int32_t kept = std::min(made, slots);
  archive->index(&made, 0, kMostCount);
  archive->index(&kept, 0, made);
  for (int32_t k = made - kept; archive->ok() && k < made; ++k) {
    const bool lost = archive->loading() && k < made - slots;
    Retired merge;
    if (!archive->loading()) merge = merges_[(read_ + k) % slots];
    visit_merge(archive, next_submap, &merge);
    if (archive->loading() && !lost) merges_[k % slots] = merge;
  }
  if (!archive->loading()) return;
  made_ = made;
  read_ = 0;
}

void Outbox::visit_merge(Archive* archive, int32_t next_submap, Retired* merge) {
  archive->index(&merge->submap, 0, next_submap - 1);
  archive->index(&merge->anchor, 0, next_submap - 1);
  archive->pose(&merge->T);
  archive->index(&merge->segment, 0, kMostId);
}

}  // namespace unisim
