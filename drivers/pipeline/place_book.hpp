// SPDX-License-Identifier: MIT
// The keyframes that a predictor keeps for loops, and which of them look like a given one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "drivers/common/place_store.hpp"
#include "drivers/predictor.h"

namespace unisim::pipeline {

/// Tells the predictor which keyframe it need not keep.
class PlaceBook {
 public:
  /// @param predictor with release_place(); borrowed
  /// @throws std::bad_alloc
  PlaceBook(unisim_predictor* predictor, int32_t capacity, int32_t dimension);

  /// A keyframe that the predictor keeps. What makes room is released; or the keyframe itself where
  /// nothing may, or where its descriptor is none (all zero, or holds -128).
  void add(int32_t id, const int8_t* descriptor);
  /// The map no longer holds keyframes before `first`.
  void forget_before(int32_t first);

  /// See drivers::PlaceStore.
  const std::vector<unisim_places_match>& query(const unisim_places_question& question,
                                                int32_t most) {
    return places_.query(question, most);
  }

  /// Up to `most` places nearest to `id`, not further than `reach` from it, ascending.
  /// @param newest none after it
  std::vector<int32_t> around(int32_t id, int32_t most, int32_t reach, int32_t newest) const;

  bool holds(int32_t id) const { return std::binary_search(ids_.begin(), ids_.end(), id); }
  int64_t bytes() const;

 private:
  void release(int32_t id);

  unisim_predictor* predictor_;
  drivers::PlaceStore places_;
  std::vector<int32_t> ids_;  // that are kept, ascending
};

}  // namespace unisim::pipeline
