// SPDX-License-Identifier: MIT
// The submaps of a session, with their views and the keyframes they share.
#include "core/map/submap_table.hpp"

#include <algorithm>

namespace unisim {

SubmapTable::SubmapTable(Arena& arena, const SubmapTableSize& size, int32_t first_id)
    : views_each_(size.views),
      most_windows_(size.windows),
      most_loops_(size.loops),
      slots_(arena.take<Submap>(size.windows + size.loops)),
      order_(arena, slots_.size()),
      free_slots_(arena, slots_.size()),
      ids_(arena.take<int32_t>(slots_.size() * size.views)),
      views_(arena.take<SubmapView>(size.live * size.views)),
      free_views_(arena, size.live),
      shared_(arena, size.shared),
      next_id_(first_id) {
  if (arena.dry()) return;
  for (int32_t slot = slots_.size() - 1; slot >= 0; --slot) {
    static_cast<void>(free_slots_.push_back(slot));
  }
  for (int32_t live = size.live - 1; live >= 0; --live) {
    static_cast<void>(free_views_.push_back(live * size.views));
  }
}

/// Few are erased out of order, so that the distance to the oldest is a good guess.
int32_t SubmapTable::slot_of(int32_t id) const {
  if (order_.empty() || id < at(0).id || id > at(size() - 1).id) return -1;
  const int32_t guess = std::min(id - at(0).id, size() - 1);
  if (at(guess).id == id) return order_[guess];
  const auto older = [&](int32_t slot, int32_t wanted) { return slots_[slot].id < wanted; };
  const int32_t slot = *std::lower_bound(order_.begin(), order_.end(), id, older);
  return slots_[slot].id == id ? slot : -1;
}

/// Keyframe ids and no views yet; in order when its id is the largest.
Submap& SubmapTable::take_slot(bool is_loop) {
  const int32_t slot = free_slots_.back();
  free_slots_.pop_back();
  Submap& submap = slots_[slot];
  submap = Submap();
  submap.is_loop = is_loop;
  submap.first_id = slot * views_each_;
  submap.first_view = -1;
  static_cast<void>(order_.push_back(slot));
  ++(is_loop ? loops_ : windows_);
  return submap;
}

void SubmapTable::take_views(Submap* submap) {
  submap->first_view = free_views_.back();
  free_views_.pop_back();
  for (int32_t k = 0; k < submap->count; ++k) view(*submap, k) = SubmapView();
}

int32_t SubmapTable::append(bool is_loop, int32_t views) {
  Submap& submap = take_slot(is_loop);
  submap.id = next_id_++;
  submap.count = views;
  take_views(&submap);
  return submap.id;
}

void SubmapTable::remove_last() {
  erase(at(size() - 1).id);
  --next_id_;
}

void SubmapTable::release_views(Submap* submap) {
  if (submap->first_view < 0) return;
  static_cast<void>(free_views_.push_back(submap->first_view));
  submap->first_view = -1;
}

void SubmapTable::erase(int32_t id) {
  const int32_t slot = slot_of(id);
  Submap& submap = slots_[slot];
  release_views(&submap);
  --(submap.is_loop ? loops_ : windows_);
  int32_t position = 0;
  while (order_[position] != slot) ++position;
  for (; position + 1 < order_.size(); ++position) order_[position] = order_[position + 1];
  order_.pop_back();
  static_cast<void>(free_slots_.push_back(slot));
  submap = Submap();
}

void SubmapTable::drop_shared(int32_t id) {
  int32_t kept = 0;
  for (int32_t k = 0; k < shared_.size(); ++k) {
    if (shared_[k].m != id && shared_[k].n != id) shared_[kept++] = shared_[k];
  }
  shared_.resize(kept);
}

}  // namespace unisim
