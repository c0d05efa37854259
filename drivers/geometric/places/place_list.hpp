// SPDX-License-Identifier: MIT
// The keyframes of the state by what they look like.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/common/place_store.hpp"

namespace unisim::geometric {

class PlaceList {
 public:
  /// Throws std::bad_alloc.
  explicit PlaceList(int32_t keyframes);

  /// @param descriptor of describe_image()
  void add(int32_t keyframe, const int8_t* descriptor);
  /// Keyframes before `first` are no longer in the state.
  void forget_before(int32_t first);
  /// The keyframes most like a descriptor, at least `gap` from keyframe `id` and `spread` apart.
  const std::vector<unisim_places_match>& query(int32_t id, const int8_t* descriptor, int32_t gap,
                                                int32_t spread, int32_t most);
  int64_t bytes() const { return places_.bytes(); }

 private:
  drivers::PlaceStore places_;
  int32_t first_ = 0;
};

}  // namespace unisim::geometric
