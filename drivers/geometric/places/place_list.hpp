// SPDX-License-Identifier: MIT
// The keyframes of the state by what they look like: unisim/places.h in memory of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "unisim/places.h"

namespace unisim::geometric {

class PlaceList {
 public:
  /// Throws std::bad_alloc.
  explicit PlaceList(int32_t keyframes);
  ~PlaceList() { unisim_places_destroy(places_); }
  PlaceList(const PlaceList&) = delete;
  PlaceList& operator=(const PlaceList&) = delete;

  /// @param descriptor of describe_image()
  void add(int32_t keyframe, const int8_t* descriptor);
  /// Keyframes before `first` are no longer in the state.
  void forget_before(int32_t first);
  /// The keyframes most like a descriptor, at least `gap` from keyframe `id` and `spread` apart.
  const std::vector<unisim_places_match>& query(int32_t id, const int8_t* descriptor, int32_t gap,
                                                int32_t spread, int32_t most);
  int64_t bytes() const { return static_cast<int64_t>(arena_bytes_); }

 private:
  size_t arena_bytes_ = 0;
  std::unique_ptr<char[]> arena_;
  unisim_places* places_ = nullptr;
  int32_t first_ = 0;
  std::vector<unisim_places_match> matches_;
};

}  // namespace unisim::geometric
