// SPDX-License-Identifier: MIT
// The keyframes of the state by what they look like.
#include "drivers/geometric/places/place_list.hpp"

#include <new>

#include "drivers/geometric/places/vlad.hpp"

namespace unisim::geometric {

PlaceList::PlaceList(int32_t keyframes) {
  unisim_places_config config;
  if (unisim_places_config_init(&config, sizeof config) != UNISIM_OK) throw std::bad_alloc();
  config.capacity = keyframes;
  config.dimension = kVladSize;
  if (unisim_places_arena_size(&config, &arena_bytes_) != UNISIM_OK) throw std::bad_alloc();
  arena_.reset(new char[arena_bytes_]);
  if (unisim_places_create(&places_, &config, arena_.get(), arena_bytes_) != UNISIM_OK) {
    throw std::bad_alloc();
  }
}

void PlaceList::add(int32_t keyframe, const int8_t* descriptor) {
  // Refused where there is nothing to see; such a keyframe is found by nothing.
  static_cast<void>(unisim_places_add(places_, keyframe, descriptor, nullptr) == UNISIM_OK);
}

void PlaceList::forget_before(int32_t first) {
  for (; first_ < first; ++first_) {
    // Not every keyframe was added.
    static_cast<void>(unisim_places_remove(places_, first_) == UNISIM_OK);
  }
}

const std::vector<unisim_places_match>& PlaceList::query(int32_t id, const int8_t* descriptor,
                                                         int32_t gap, int32_t spread,
                                                         int32_t most) {
  unisim_places_question question{};
  question.struct_size = sizeof question;
  question.id = id;
  question.gap = gap;
  question.spread = spread;
  question.descriptor = descriptor;
  matches_.resize(static_cast<size_t>(most));
  int32_t count = 0;
  if (unisim_places_query(places_, &question, matches_.data(), most, &count) != UNISIM_OK) {
    count = 0;
  }
  matches_.resize(static_cast<size_t>(count));
  return matches_;
}

}  // namespace unisim::geometric
