// SPDX-License-Identifier: MIT
// The keyframes of the state by what they look like.
#include "drivers/geometric/places/place_list.hpp"

#include <algorithm>

namespace unisim::geometric {

PlaceList::PlaceList(int32_t keyframes)
    : places_(keyframes, kVladSize), entries_(static_cast<size_t>(keyframes)) {}

void PlaceList::add(int32_t keyframe, const int8_t* descriptor) {
  // Refused where there is nothing to see; such a keyframe is found by nothing.
  if (!places_.add(keyframe, descriptor)) return;
  entry(keyframe).keyframe = keyframe;
  std::copy(descriptor, descriptor + kVladSize, entry(keyframe).descriptor.begin());
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

void PlaceList::archive(drivers::Archive* io, int32_t first, int32_t end) {
  io->part("places");
  for (int32_t id = first; id < end; ++id) {
    bool kept = entry(id).keyframe == id;
    io->flag(kept);
    if (!kept) continue;
    Entry& place = entry(id);
    io->bytes(place.descriptor.data(), place.descriptor.size());
    if (!io->reading()) continue;
    place.keyframe = id;
    io->require(places_.add(id, place.descriptor.data()), "a descriptor is none");
  }
  if (io->reading()) first_ = first;
}

}  // namespace unisim::geometric
