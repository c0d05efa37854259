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
  Entry* place = find(kFree);
  place->keyframe = keyframe;
  std::copy(descriptor, descriptor + kVladSize, place->descriptor.begin());
}

void PlaceList::keep(const std::vector<int32_t>& held) {
  for (Entry& place : entries_) {
    if (place.keyframe == kFree) continue;
    if (std::binary_search(held.begin(), held.end(), place.keyframe)) continue;
    places_.remove(place.keyframe);
    place.keyframe = kFree;
  }
}

PlaceList::Entry* PlaceList::find(int32_t keyframe) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [keyframe](const Entry& place) {
    return place.keyframe == keyframe;
  });
  return found == entries_.end() ? nullptr : &*found;
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

void PlaceList::archive(drivers::Archive* io, const std::vector<int32_t>& held) {
  io->part("places");
  for (const int32_t id : held) {
    Entry* place = find(io->reading() ? kFree : id);
    bool kept = !io->reading() && place != nullptr;
    io->flag(kept);
    if (!kept) continue;
    io->bytes(place->descriptor.data(), place->descriptor.size());
    if (!io->reading()) continue;
    place->keyframe = id;
    io->require(places_.add(id, place->descriptor.data()), "a descriptor is none");
  }
}

}  // namespace unisim::geometric
