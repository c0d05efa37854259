// SPDX-License-Identifier: MIT
// How well the camera is followed (METHOD: init, tracking, degraded, lost, relocalised).
#pragma once

#include <cstdint>

#include "core/snapshot/archive.hpp"

namespace unisim {

/// The numbers are those of unisim.h; capi asserts that they agree.
enum class Tracking : int32_t {
  kInit = 0,         ///< no pair has been accepted yet
  kTracking = 1,     ///< the last pair was accepted
  kDegraded = 2,     ///< the last pair was refused and the pose is held, or its scale is a guess
  kLost = 3,         ///< `lost_after` pairs in a row were refused
  kRelocalised = 4,  ///< found again after a loss, or a loop has just joined two segments
};

/// State machine fed by the fate of each pair.
class TrackingState {
 public:
  explicit TrackingState(int32_t lost_after) : lost_after_(lost_after) {}

  /// @param doubtful its scale is hardly known
  void pair_accepted(bool doubtful) {
    refused_in_a_row_ = 0;
    state_ = doubtful ? Tracking::kDegraded : Tracking::kTracking;
  }
  /// Before the first accepted pair there is nothing to lose: the state stays kInit.
  void pair_refused() {
    if (state_ == Tracking::kInit) return;
    ++refused_in_a_row_;
    const bool lost = refused_in_a_row_ >= lost_after_;
    if (lost && state_ != Tracking::kLost) ++lost_events_;
    state_ = lost ? Tracking::kLost : Tracking::kDegraded;
  }
  void relocalised() { state_ = Tracking::kRelocalised; }

  Tracking state() const { return state_; }
  int32_t lost_events() const { return lost_events_; }

  /// Save or load.
  void visit(Archive* archive) {
    archive->choice(&state_, Tracking::kRelocalised);
    archive->index(&refused_in_a_row_, 0, kMostCount);
    archive->index(&lost_events_, 0, kMostCount);
  }

 private:
  int32_t lost_after_;
  Tracking state_ = Tracking::kInit;
  int32_t refused_in_a_row_ = 0;
  int32_t lost_events_ = 0;
};

}  // namespace unisim
