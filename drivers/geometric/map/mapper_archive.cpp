// SPDX-License-Identifier: MIT
// The map as it is saved: what a later run needs to find itself in it and to go on.
#include <algorithm>

#include "drivers/geometric/map/mapper.hpp"

namespace unisim::geometric {

namespace {
constexpr int32_t kMostSegments = 1 << 20;
constexpr double kMostDepth = 1e9;  // units of the map
}  // namespace

bool Mapper::has_map() const {
  const std::vector<int32_t>& ids = state_.map.ids();
  return std::any_of(ids.begin(), ids.end(),
                     [this](int32_t k) { return state_.map.keyframe(k).posed; });
}

void Mapper::archive(drivers::Archive* io) {
  state_.intrinsics.archive(io, state_.size);
  io->part("segments");
  io->number(state_.segments, 1, kMostSegments);
  io->number(state_.median_depth, 0.0, kMostDepth);
  state_.map.archive(io, state_.segments, state_.intrinsics.readout_s);
  archive_looks(io);
  places_.archive_keyframes(io, state_.map.ids());
  if (!io->reading()) return;
  io->require(has_map(), "no keyframe has a pose");
  const std::vector<int32_t>& ids = state_.map.ids();
  const auto newest = std::find_if(ids.rbegin(), ids.rend(),
                                   [this](int32_t k) { return state_.map.keyframe(k).posed; });
  state_.enter(state_.map.keyframe(*newest).segment);
  state_.initialised = true;
  lost_intrinsics_ = state_.intrinsics;
  counts_.started = 1;
}

void Mapper::archive_looks(drivers::Archive* io) {
  io->part("patches");
  for (int32_t slot = 0; slot < state_.map.landmark_capacity(); ++slot) {
    if (state_.map.lasts(slot)) patches_.archive(io, slot, state_.map.landmark(slot).generation);
  }
  io->part("descriptors");
  for (int32_t slot = 0; slot < state_.map.landmark_capacity(); ++slot) {
    if (!state_.map.lasts(slot)) continue;
    places_.archive_landmark(io, slot, state_.map.landmark(slot).generation);
  }
}

}  // namespace unisim::geometric
