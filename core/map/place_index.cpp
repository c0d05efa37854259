// SPDX-License-Identifier: MIT
// Descriptors of places, and those most like a given one.
#include "core/map/place_index.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>

#include "core/map/place_scores.hpp"

namespace unisim {
namespace {

constexpr int32_t kTaken = std::numeric_limits<int32_t>::min();  // no score is as low

Span<unsigned char> take_index(Arena& arena) {
  return arena.take<unsigned char>(static_cast<int32_t>(sizeof(PlaceIndex)));
}

bool near(int32_t a, int32_t b, int32_t distance) {
  const int64_t apart = static_cast<int64_t>(a) - b;
  return (apart < 0 ? -apart : apart) < distance;
}

}  // namespace

bool PlaceIndex::valid(const PlaceIndexConfig& config) {
  // One array holds all descriptors.
  const int64_t numbers = (static_cast<int64_t>(config.capacity) + 1) * config.dimension;
  return config.capacity >= 1 && config.capacity <= kMaxCapacity && config.dimension >= 1 &&
         config.dimension <= kMaxDimension && numbers <= std::numeric_limits<int32_t>::max() &&
         config.same_place >= 0.0 && config.same_place <= 1.0;
}

PlaceIndex::PlaceIndex(const PlaceIndexConfig& config, Arena& arena)
    : config_(config),
      entries_(arena.take<Entry>(config.capacity + 1)),
      descriptors_(arena.take<int8_t>((config.capacity + 1) * config.dimension)),
      scores_(arena.take<int32_t>(config.capacity + 1)),
      stride_(config.dimension) {}

Arena PlaceIndex::measure(const PlaceIndexConfig& config) {
  Arena arena;
  static_cast<void>(take_index(arena));
  const PlaceIndex dry(config, arena);
  return arena;
}

Status PlaceIndex::create(const PlaceIndexConfig& config, void* memory, size_t bytes,
                          PlaceIndex** index) {
  Arena arena(memory, bytes);
  if (bytes < measure(config).required_bytes()) return Status::kOutOfMemory;
  const Span<unsigned char> place = take_index(arena);
  if (place.data() == nullptr) return Status::kOutOfMemory;
  *index = ::new (static_cast<void*>(place.data())) PlaceIndex(config, arena);
  (*index)->memory_ = memory;
  (*index)->memory_bytes_ = bytes;
  return Status::kOk;
}

int8_t* PlaceIndex::row(int32_t slot) const { return descriptors_.data() + slot * stride_; }

bool PlaceIndex::good(const int8_t* descriptor) const {
  bool any = false;
  for (int32_t k = 0; k < config_.dimension; ++k) {
    if (descriptor[k] == std::numeric_limits<int8_t>::min()) return false;
    any = any || descriptor[k] != 0;
  }
  return any;
}

double PlaceIndex::likeness(int32_t a, int32_t b, int32_t score) const {
  const double square = static_cast<double>(score) * score /
                        (static_cast<double>(entries_[a].norm) * entries_[b].norm);
  return score < 0 ? -square : square;
}

void PlaceIndex::note(int32_t slot, int32_t other, double alike) {
  if (alike <= entries_[slot].likeness) return;
  entries_[slot].likeness = alike;
  entries_[slot].nearest = other;
}

/// Leaves the scores of the entry with all in scores_.
void PlaceIndex::find_nearest(int32_t slot) {
  UNISIM_DISPATCH(
      place_scores(row(slot), descriptors_.data(), size_, config_.dimension, scores_.data()));
  entries_[slot].norm = scores_[slot];
  entries_[slot].nearest = -1;
  entries_[slot].likeness = kLeastLike;
  for (int32_t other = 0; other < size_; ++other) {
    if (other != slot) note(slot, other, likeness(slot, other, scores_[other]));
  }
}

/// The last entry takes the place of one that goes.
void PlaceIndex::drop(int32_t slot) {
  const int32_t last = --size_;
  if (slot != last) {
    entries_[slot] = entries_[last];
    std::memcpy(row(slot), row(last), static_cast<size_t>(stride_));
  }
  for (int32_t k = 0; k < size_; ++k) {
    if (entries_[k].nearest == slot) {
      find_nearest(k);
    } else if (entries_[k].nearest == last) {
      entries_[k].nearest = slot;
    }
  }
}

/// The older of the two entries that are most alike; -1 when none are alike enough.
int32_t PlaceIndex::most_redundant() const {
  int32_t best = -1;
  double alike = kLeastLike;
  for (int32_t k = 0; k < size_; ++k) {
    const Entry& entry = entries_[k];
    if (entry.nearest < 0 || entry.likeness < config_.same_place * config_.same_place) continue;
    const int32_t older = entry.id < entries_[entry.nearest].id ? k : entry.nearest;
    const bool better = best < 0 || entry.likeness > alike ||
                        (entry.likeness == alike && entries_[older].id < entries_[best].id);
    if (!better) continue;
    best = older;
    alike = entry.likeness;
  }
  return best;
}

Status PlaceIndex::add(int32_t id, const int8_t* descriptor, int32_t* evicted) {
  if (id <= newest_id_ || !good(descriptor)) return Status::kInvalidArgument;
  const int32_t slot = size_;
  entries_[slot] = Entry();
  entries_[slot].id = id;
  std::memcpy(row(slot), descriptor, static_cast<size_t>(stride_));
  ++size_;
  find_nearest(slot);
  if (size_ > config_.capacity && most_redundant() < 0) {
    --size_;
    return Status::kCapacity;
  }
  for (int32_t other = 0; other < slot; ++other) {
    note(other, slot, likeness(slot, other, scores_[other]));
  }
  *evicted = -1;
  if (size_ > config_.capacity) {
    const int32_t victim = most_redundant();
    *evicted = entries_[victim].id;
    drop(victim);
  }
  newest_id_ = id;
  return Status::kOk;
}

Status PlaceIndex::remove(int32_t id) {
  for (int32_t slot = 0; slot < size_; ++slot) {
    if (entries_[slot].id != id) continue;
    drop(slot);
    return Status::kOk;
  }
  return Status::kInvalidArgument;
}

int32_t PlaceIndex::query(const PlaceQuery& query, Span<PlaceMatch> matches) {
  UNISIM_DISPATCH(place_scores(query.descriptor, descriptors_.data(), size_, config_.dimension,
                               scores_.data()));
  for (int32_t k = 0; k < size_; ++k) {
    if (near(entries_[k].id, query.id, query.gap)) scores_[k] = kTaken;
  }
  int32_t found = 0;
  for (; found < matches.size(); ++found) {
    int32_t best = -1;
    for (int32_t k = 0; k < size_; ++k) {
      if (scores_[k] == kTaken) continue;
      const bool better = best < 0 || scores_[k] > scores_[best] ||
                          (scores_[k] == scores_[best] && entries_[k].id < entries_[best].id);
      if (better) best = k;
    }
    if (best < 0) break;
    matches[found] = {entries_[best].id, scores_[best]};
    for (int32_t k = 0; k < size_; ++k) {
      if (k == best || near(entries_[k].id, entries_[best].id, query.spread)) scores_[k] = kTaken;
    }
  }
  return found;
}

}  // namespace unisim
