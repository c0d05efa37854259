// SPDX-License-Identifier: MIT
// Which windows of keyframes want a multi-view prediction.
#include "core/map/submap_window.hpp"

#include <algorithm>

namespace unisim {

bool WindowSchedule::append(const Window& window, Window* skipped) {
  covered_ = window.first + window.count;
  next_first_ = std::max<int32_t>(covered_ - overlap_, 0);
  const bool room = endless_ ? !open_.full() : cut_ < open_.capacity();
  if (!room) *skipped = endless_ ? open_[0] : window;
  if (!room && !endless_) return false;
  if (!room) remove(0);
  if (!endless_) ++cut_;
  return open_.push_back(window) && room;
}

bool WindowSchedule::keyframe_added(int32_t keyframes, Window* skipped) {
  if (keyframes < next_first_ + size_) return true;
  return append({next_first_, size_}, skipped);
}

bool WindowSchedule::close(int32_t keyframes) {
  constexpr int32_t kFewestNew = 2;
  if (keyframes - covered_ < kFewestNew) return false;
  Window skipped;
  return append({next_first_, keyframes - next_first_}, &skipped) || endless_;
}

const Window* WindowSchedule::oldest(int32_t settled) const {
  for (const Window& window : open_) {
    if (window.last() <= settled) return &window;
  }
  return nullptr;
}

int32_t WindowSchedule::find(int32_t first, int32_t last) const {
  int32_t holder = -1;
  for (int32_t i = 0; i < open_.size(); ++i) {
    if (open_[i].first == first && open_[i].last() == last) return i;
    if (holder < 0 && open_[i].holds(first) && open_[i].holds(last)) holder = i;
  }
  return holder;
}

bool WindowSchedule::drop_before(int32_t keyframe, Window* dropped) {
  for (int32_t i = 0; i < open_.size(); ++i) {
    if (open_[i].first >= keyframe) continue;
    *dropped = open_[i];
    remove(i);
    return true;
  }
  return false;
}

void WindowSchedule::remove(int32_t index) {
  for (int32_t i = index; i + 1 < open_.size(); ++i) open_[i] = open_[i + 1];
  open_.pop_back();
}

void WindowSchedule::visit(Archive* archive, int32_t keyframes) {
  archive->index(&covered_, 0, keyframes);
  archive->index(&next_first_, 0, covered_);
  archive->index(&cut_, 0, keyframes);
  archive->need("window_size", keyframes - next_first_ + 1, size_);
  int32_t count = open_.size();
  archive->index(&count, 0, keyframes);
  archive->need(endless_ ? "window_submaps" : "max_submaps", endless_ ? count : cut_,
                open_.capacity());
  archive->expect(endless_ || count <= cut_);
  if (!archive->ok()) return;
  if (archive->loading()) open_.resize(count);
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    Window& window = open_[k];
    archive->index(&window.first, 0, keyframes - 1);
    archive->index(&window.count, 1, keyframes - window.first);
    archive->need("window_size", window.count, size_);
  }
}

}  // namespace unisim
