// SPDX-License-Identifier: MIT
// Loops found and not yet in the map: they wait for a second keyframe that agrees, then for the
// next adjustment of the whole state, to which they give their observations.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/geometric/map/state.hpp"
#include "drivers/geometric/places/place_finder.hpp"

namespace unisim::geometric {

inline constexpr size_t kMostLoopMatches = 150;  ///< of one keyframe

/// Those of a place's matches that are kept.
void keep_matches(const PlaceFound& found, std::vector<PatchMatch>* kept);
/// Matches of a keyframe with landmarks that are still there become observations.
void append_observations(const State& state, int32_t keyframe,
                         const std::vector<PatchMatch>& matches, std::vector<LoopObservation>* out);

class LoopBook {
 public:
  LoopBook();

  /// Keyframe `id` was found at `found.pose`; the state has it elsewhere, by the drift of the loop.
  void add(const State& state, int32_t id, const PlaceFound& found);
  /// Drops loops that no keyframe agreed with in time. @return their keyframes
  const std::vector<int32_t>& drop_unconfirmed(int32_t newest);
  /// The segment's world is no longer the one that its loops were found in.
  void forget(int32_t segment);
  /// Is there a loop that counts, of this segment?
  bool waiting(int32_t segment) const;
  /// Is there one that waits for a second to agree?
  bool hoping() const;
  /// Hands over the observations of the loops that count, by landmark and keyframe.
  void take(const State& state, std::vector<LoopObservation>* out);
  int64_t bytes() const;

 private:
  struct Loop {
    int32_t keyframe = -1;
    int32_t segment = 0;
    bool counts = false;
    bool taken = true;  // free
    CameraPose found;   // where it was found in the map
    std::vector<PatchMatch> matches;
  };
  static bool agree(const State& state, const Loop& a, const Loop& b);

  std::array<Loop, 16> loops_;
  size_t next_ = 0;
  std::vector<int32_t> dropped_;
};

}  // namespace unisim::geometric
