// SPDX-License-Identifier: MIT
// Which keyframes are held, and in which slot of fixed memory each stands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace unisim::geometric {

/// A set of keyframe ids with a slot each. Ids only grow, any of them may be dropped. Finding is a
/// hash table with open addressing (linear probing, at most a quarter full): it is asked for each
/// observation. Nothing allocates after construction.
class KeyframeSlots {
 public:
  static constexpr int32_t kNone = -1;

  explicit KeyframeSlots(int32_t capacity);

  bool full() const { return ids_.size() == ids_.capacity(); }
  /// Ids held, ascending.
  const std::vector<int32_t>& ids() const { return ids_; }
  /// Slot of an id, kNone when it is not held.
  int32_t find(int32_t id) const {
    for (size_t at = home(id);; at = (at + 1) & mask_) {
      if (table_[at].id == id) return table_[at].slot;
      if (table_[at].id == kNone) return kNone;
    }
  }
  /// Gives a slot to an id above all that are held; not full(). @return the slot
  int32_t take(int32_t id);
  /// `id` is held.
  void drop(int32_t id);

  int64_t bytes() const {
    return static_cast<int64_t>((ids_.capacity() + free_.capacity()) * sizeof(int32_t) +
                                table_.capacity() * sizeof(Entry));
  }

 private:
  struct Entry {
    int32_t id = kNone;
    int32_t slot = kNone;
  };
  // Fibonacci hashing: neighbouring ids spread over the table.
  size_t home(int32_t id) const {
    return (static_cast<uint32_t>(id) * 2654435769U) >> shift_ & mask_;
  }

  std::vector<int32_t> ids_;
  std::vector<int32_t> free_;
  std::vector<Entry> table_;
  size_t mask_ = 0;
  int shift_ = 0;
};

}  // namespace unisim::geometric
