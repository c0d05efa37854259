// SPDX-License-Identifier: MIT
// The keyframes of the state by what they look like.
#include "drivers/geometric/places/place_list.hpp"

#include "drivers/geometric/places/vlad.hpp"

namespace unisim::geometric {

PlaceList::PlaceList(int32_t keyframes) : places_(keyframes, kVladSize) {}

void PlaceList::add(int32_t keyframe, const int8_t* descriptor) {
  // Refused where there is nothing to see; such a keyframe is found by nothing.
  static_cast<void>(places_.add(keyframe, descriptor));
}

void PlaceList::forget_before(int32_t first) {
  // Not every keyframe was added.
  for (; first_ < first; ++first_) places_.remove(first_);
}

const std::vector<unisim_places_match>& PlaceList::query(int32_t id, const int8_t* descriptor,
                                                         int32_t gap, int32_t spread,
                                                         int32_t most) {
  unisim_places_question question{};
  question.id = id;
  question.gap = gap;
  question.spread = spread;
  question.descriptor = descriptor;
  return places_.query(question, most);
}

}  // namespace unisim::geometric
