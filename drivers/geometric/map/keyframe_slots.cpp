// SPDX-License-Identifier: MIT
// Which keyframes are held, and in which slot of fixed memory each stands.
#include "drivers/geometric/map/keyframe_slots.hpp"

#include <algorithm>

namespace unisim::geometric {

namespace {
constexpr size_t kRoom = 4;  // entries of the table for each keyframe
constexpr int kHashBits = 32;
}  // namespace

KeyframeSlots::KeyframeSlots(int32_t capacity) {
  ids_.reserve(static_cast<size_t>(capacity));
  free_.reserve(static_cast<size_t>(capacity));
  for (int32_t slot = capacity; slot-- > 0;) free_.push_back(slot);
  int bits = 1;
  while ((size_t{1} << bits) < kRoom * static_cast<size_t>(capacity)) ++bits;
  table_.resize(size_t{1} << bits);
  mask_ = table_.size() - 1;
  shift_ = kHashBits - bits;
}

int32_t KeyframeSlots::take(int32_t id) {
  const int32_t slot = free_.back();
  free_.pop_back();
  ids_.push_back(id);
  size_t at = home(id);
  while (table_[at].id != kNone) at = (at + 1) & mask_;
  table_[at] = {id, slot};
  return slot;
}

void KeyframeSlots::drop(int32_t id) {
  ids_.erase(std::lower_bound(ids_.begin(), ids_.end(), id));
  size_t hole = home(id);
  while (table_[hole].id != id) hole = (hole + 1) & mask_;
  free_.push_back(table_[hole].slot);
  // Entries that had moved on past the hole move back, so that find() may stop at an empty one.
  for (size_t at = (hole + 1) & mask_; table_[at].id != kNone; at = (at + 1) & mask_) {
    const size_t from_home = (at - home(table_[at].id)) & mask_;
    if (from_home < ((at - hole) & mask_)) continue;
    table_[hole] = table_[at];
    hole = at;
  }
  table_[hole] = {};
}

}  // namespace unisim::geometric
