// SPDX-License-Identifier: MIT
// The map as it is saved: what a later run needs to find itself in it and to go on.
#include "drivers/geometric/map/mapper.hpp"

namespace unisim::geometric {

namespace {
constexpr int32_t kMostSegments = 1 << 20;
constexpr double kMostDepth = 1e9;  // units of the map
}  // namespace

bool Mapper::has_map() const {
  for (int32_t k = state_.map.first_id(); k < state_.map.end_id(); ++k) {
    if (state_.map.keyframe(k).posed) return true;
  }
  return false;
}

void Mapper::archive(drivers::Archive* io) {
  state_.intrinsics.archive(io, state_.size);
  io->part("segments");
  io->number(state_.segments, 1, kMostSegments);
  io->number(state_.median_depth, 0.0, kMostDepth);
  state_.map.archive(io, state_.segments);
  archive_looks(io);
  places_.archive_keyframes(io, state_.map.first_id(), state_.map.end_id());
  if (!io->reading()) return;
  io->require(has_map(), "no keyframe has a pose");
  int32_t newest = state_.map.end_id() - 1;
  while (!state_.map.keyframe(newest).posed) --newest;
  state_.enter(state_.map.keyframe(newest).segment);
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
