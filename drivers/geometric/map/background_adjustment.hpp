// SPDX-License-Identifier: MIT
// Adjusts the whole state now and then, beside tracking: on a copy, in a thread of its own, merged
// at a fixed later keyframe, so that the result does not depend on the thread's speed.
#pragma once

#include <algorithm>
#include <vector>

#include "drivers/geometric/bundle/world_move.hpp"
#include "drivers/geometric/map/background_worker.hpp"
#include "drivers/geometric/map/keyframe_pose.hpp"
#include "drivers/geometric/map/map_adjustment.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

class BackgroundAdjustment {
 public:
  /// @param threaded false: the work is done within start(); the results are the same
  BackgroundAdjustment(const BundleCapacity& capacity, const MapCapacity& map, bool threaded);

  bool running() const { return pending_; }
  /// Keyframe with which the pending adjustment is due to be merged. A larger state takes longer.
  int32_t due_at(int32_t latency) const {
    return started_at_ + std::max(latency, static_cast<int32_t>(keyframes_.size()) / 12);
  }

  /// Keyframes of the adjustment merged last, spread evenly over all of them.
  const std::vector<int32_t>& spread() const { return spread_; }
  /// Precision of their centres, that of the intrinsics included; 0 when not known.
  double spread_sigma() const { return spread_sigma_; }

  /// Copies the segment's posed keyframes and begins.
  /// @param loops observations to take in, by landmark and keyframe; emptied. merge() puts those
  ///              that fit then into the map
  /// @param joined keyframes of a segment that was joined to this one: spread() has some of them
  void start(const State& state, int32_t keyframe, int iterations,
             std::vector<LoopObservation>* loops, const std::vector<int32_t>& joined);
  /// Waits for the result and takes it into the state; what was added meanwhile moves along;
  /// keyframes that do not fit so are posed anew by `poses`.
  /// Throws what the adjustment threw. @return false when the result no longer fits (the segment
  /// ended)
  bool merge(State* state, KeyframePose* poses);

  int64_t bytes() const { return adjustment_.bytes(); }

 private:
  void choose_spread(const std::vector<int32_t>& joined);
  void work();
  /// From the present world to the adjusted one.
  WorldMove move_of_newest(const State& state);
  void move_rest(const WorldMove& move, State* state);
  void take(State* state);
  void take_loops(State* state);
  void pose_later(State* state, KeyframePose* poses) const;

  MapAdjustment adjustment_;
  std::vector<int32_t> keyframes_;
  std::vector<int32_t> spread_;
  std::vector<int32_t> spread_from_;
  std::vector<LoopObservation> loops_;
  std::vector<double> ratios_;
  std::vector<uint8_t> adjusted_;  // by landmark: is in the problem
  int32_t segment_ = 0;
  int32_t started_at_ = 0;
  int iterations_ = 0;
  bool usable_ = false;
  double log_focal_sigma_ = 0;
  double spread_sigma_ = 0;
  bool pending_ = false;
  BackgroundWorker worker_;  // last: its thread ends before what it works on
};

}  // namespace unisim::geometric
