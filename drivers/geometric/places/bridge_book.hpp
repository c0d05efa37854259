// SPDX-License-Identifier: MIT
// Keyframes found in another segment of the map, until enough of them say how the two lie.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/geometric/bundle/world_move.hpp"
#include "drivers/geometric/places/place_finder.hpp"

namespace unisim::geometric {

/// How another segment lies to the present one.
struct SegmentJoin {
  int32_t segment = -1;  ///< the other one
  WorldMove move;        ///< from its world to that of the present segment
};

class BridgeBook {
 public:
  BridgeBook();

  /// Keyframe `id` of the present segment was found in the segment of `found.keyframe`.
  void add(const State& state, int32_t id, const PlaceFound& found);
  /// Does one wait for others to agree?
  bool hoping() const;
  /// Drops those that have waited too long, or whose segment is no longer followed. @return their
  /// keyframes
  const std::vector<int32_t>& drop_old(const State& state, int32_t newest);
  /// When enough agree: takes them out and says how the segments lie.
  /// @param observations of the other segment's landmarks in keyframes of the present one, by
  ///                     landmark and keyframe
  bool take(const State& state, SegmentJoin* out, std::vector<LoopObservation>* observations);

  int64_t bytes() const;

 private:
  struct Bridge {
    int32_t keyframe = -1;
    int32_t segment = -1;  // of the keyframe
    int32_t other = -1;    // where it was found; -1: free
    CameraPose found;      // in the other segment's world
    std::vector<PatchMatch> matches;
    double log_scale = 0;  // of the other world to the present one
    WorldMove move;
  };
  bool measure(const State& state, Bridge* bridge);
  bool agree(const State& state, const Bridge& a, const Bridge& b) const;
  WorldMove mean_move(const State& state, const Bridge& of) const;

  std::array<Bridge, 8> bridges_;
  size_t next_ = 0;
  std::vector<double> ratios_;
  std::vector<int32_t> dropped_;
};

}  // namespace unisim::geometric
