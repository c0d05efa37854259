// SPDX-License-Identifier: MIT
// The keyframes of the state by what they look like.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/common/archive.hpp"
#include "drivers/common/place_store.hpp"
#include "drivers/geometric/places/vlad.hpp"

namespace unisim::geometric {

class PlaceList {
 public:
  /// Throws std::bad_alloc.
  explicit PlaceList(int32_t keyframes);

  /// @param descriptor of describe_image()
  void add(int32_t keyframe, const int8_t* descriptor);
  /// Keeps those of these keyframes, ascending, which the state holds.
  void keep(const std::vector<int32_t>& held);
  /// The keyframes most like a descriptor, at least `gap` from keyframe `id` and `spread` apart.
  const std::vector<unisim_places_match>& query(int32_t id, const int8_t* descriptor, int32_t gap,
                                                int32_t spread, int32_t most);
  /// Saves or loads the places. @param held keyframes that the state holds
  void archive(drivers::Archive* io, const std::vector<int32_t>& held);
  int64_t bytes() const {
    return places_.bytes() + static_cast<int64_t>(entries_.size() * sizeof(Entry));
  }

 private:
  static constexpr int32_t kFree = -1;
  struct Entry {
    int32_t keyframe = kFree;
    std::array<int8_t, kVladSize> descriptor{};
  };
  Entry* find(int32_t keyframe);

  drivers::PlaceStore places_;
  std::vector<Entry> entries_;  // what was added: an index is not read out again
};

}  // namespace unisim::geometric
