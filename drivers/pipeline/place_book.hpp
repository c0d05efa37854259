// SPDX-License-Identifier: MIT
// The keyframes that a predictor keeps for loops, and which of them look like a given one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/predictor.h"
#include "unisim/places.h"

namespace unisim::pipeline {

/// unisim/places.h in memory of its own. Tells the predictor which keyframe it need not keep.
class PlaceBook {
 public:
  /// @param predictor with release_place(); borrowed
  /// @throws std::bad_alloc
  PlaceBook(unisim_predictor* predictor, int32_t capacity, int32_t dimension);
  ~PlaceBook() { unisim_places_destroy(places_); }
  PlaceBook(const PlaceBook&) = delete;
  PlaceBook& operator=(const PlaceBook&) = delete;

  /// A keyframe that the predictor keeps. What makes room is released; or the keyframe itself where
  /// nothing may, or where its descriptor is none (all zero, or holds -128).
  void add(int32_t id, const int8_t* descriptor);
  /// The map no longer holds keyframes before `first`.
  void forget_before(int32_t first);

  /// The places most like a descriptor, best first; see unisim_places_question.
  const std::vector<unisim_places_match>& query(const unisim_places_question& question,
                                                int32_t most);

  /// Up to `most` places nearest to `id`, not further than `reach` from it, ascending.
  /// @param newest none after it
  std::vector<int32_t> around(int32_t id, int32_t most, int32_t reach, int32_t newest) const;

  bool holds(int32_t id) const { return std::binary_search(ids_.begin(), ids_.end(), id); }
  int64_t bytes() const;

 private:
  void release(int32_t id);

  unisim_predictor* predictor_;
  size_t arena_bytes_ = 0;
  std::unique_ptr<char[]> arena_;
  unisim_places* places_ = nullptr;
  std::vector<int32_t> ids_;  // that are kept, ascending
  std::vector<unisim_places_match> matches_;
};

}  // namespace unisim::pipeline
