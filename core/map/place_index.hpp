// SPDX-License-Identifier: MIT
// Descriptors of places, and those most like a given one.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/status.hpp"

namespace unisim {

struct PlaceIndexConfig {
  int32_t capacity = 1024;   ///< places
  int32_t dimension = 1024;  ///< numbers of a descriptor
  double same_place = 0.4;   ///< cosine from which one of two entries may go for a newer one
};

struct PlaceMatch {
  int32_t id;
  int32_t score;
};

struct PlaceQuery {
  const int8_t* descriptor;
  int32_t id;      ///< of the query itself, whether it is kept or not
  int32_t gap;     ///< matches differ by at least so much in id from the query
  int32_t spread;  ///< and by so much from each other
};

/// Entries in memory fixed at creation: an id and a descriptor of int8 numbers each. The score of
/// two is their dot product, an order and no decision.
///
/// When full, the entry that says least goes: of the two most alike (by the cosine) the older. It
/// is never the only view of a place: where no two are as alike as `same_place`, the new one is
/// refused instead.
class PlaceIndex {
 public:
  static constexpr int32_t kMaxCapacity = 1000000;
  static constexpr int32_t kMaxDimension = 65536;  // sums of products fit 32 bits

  static bool valid(const PlaceIndexConfig& config);
  /// Arena after the layout of an index, without memory.
  static Arena measure(const PlaceIndexConfig& config);
  /// @return kOk, kOutOfMemory
  static Status create(const PlaceIndexConfig& config, void* memory, size_t bytes,
                       PlaceIndex** index);
  /// From here on, and until its memory is used otherwise, the index is not live().
  void end() {
    mark_ = 0;
    Arena::give_back(memory_, memory_bytes_);
  }
  bool live() const { return mark_ == kLiveMark; }

  /// Appends an entry; O(size * dimension), rarely a few times that when full.
  /// @param id       larger than all before
  /// @param evicted  id of the entry that went for it, -1: none
  /// @return kOk; kInvalidArgument: id not larger, descriptor all zero or with a -128; kCapacity
  Status add(int32_t id, const int8_t* descriptor, int32_t* evicted);
  /// @return kOk; kInvalidArgument: no entry has this id
  Status remove(int32_t id);
  /// The entries with the largest scores, best first; equal ones by id. Greedy: each is the best of
  /// those far enough from the query and all before it. @return number of matches
  int32_t query(const PlaceQuery& query, Span<PlaceMatch> matches);
  /// May this descriptor be added or asked for?
  bool good(const int8_t* descriptor) const;

  int32_t size() const { return size_; }

 private:
  PlaceIndex(const PlaceIndexConfig& config, Arena& arena);

  static constexpr double kLeastLike = -2.0;
  struct Entry {
    int32_t id = 0;
    int32_t norm = 0;              // its dot product with itself
    int32_t nearest = -1;          // the entry most like it
    double likeness = kLeastLike;  // with that: the square of the cosine with the cosine's sign
  };

  int8_t* row(int32_t slot) const;
  double likeness(int32_t a, int32_t b, int32_t score) const;
  void note(int32_t slot, int32_t other, double alike);
  void find_nearest(int32_t slot);
  void drop(int32_t slot);
  int32_t most_redundant() const;

  static constexpr uint32_t kLiveMark = 0x706c6163;  // unlikely in memory of another use
  const void* memory_ = nullptr;
  size_t memory_bytes_ = 0;
  uint32_t mark_ = kLiveMark;
  PlaceIndexConfig config_;
  int32_t size_ = 0;
  int32_t newest_id_ = -1;
  Span<Entry> entries_;       // one more than the capacity: a new one before an old one has gone
  Span<int8_t> descriptors_;  // of the entries, one after another
  Span<int32_t> scores_;
  int64_t stride_ = 0;
};

}  // namespace unisim
