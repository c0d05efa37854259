// SPDX-License-Identifier: MIT
// The landmarks of one place: those of a keyframe and of its neighbours, and what they look like.
#pragma once

#include <vector>

#include "drivers/geometric/map/state.hpp"
#include "drivers/geometric/places/descriptor_store.hpp"

namespace unisim::geometric {

struct PlaceView {
  int32_t keyframe = -1;
  std::vector<int32_t> landmark;  ///< slots
  size_t own = 0;                 ///< the first `own` of them were seen in the keyframe
  std::vector<OrbDescriptor> descriptor;
  std::vector<int32_t> owner;  ///< index into `landmark`, of each descriptor
};

/// Collects the landmarks of a place.
class PlaceViewer {
 public:
  explicit PlaceViewer(int32_t landmarks) : taken_(static_cast<size_t>(landmarks), 0) {}
  void collect(const State& state, const DescriptorStore& store, int32_t keyframe, PlaceView* out);

 private:
  void add_keyframe(const State& state, int32_t keyframe, PlaceView* out);
  std::vector<uint8_t> taken_;
};

}  // namespace unisim::geometric
