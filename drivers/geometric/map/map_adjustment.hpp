// SPDX-License-Identifier: MIT
// A part of the map as a bundle adjustment problem, and the way back.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

/// Problem, solver and the names of its cameras and points in the map. Memory fixed at creation.
class MapAdjustment {
 public:
  MapAdjustment(const BundleCapacity& capacity, const MapCapacity& map);

  /// Sets up the keyframes `ids` (ascending, posed) as free cameras with every placed landmark seen
  /// in them. Landmarks that reach back bring the keyframe that saw them first as a fixed camera:
  /// these hold the scale.
  /// @param loops more observations, by landmark and keyframe
  void build(const State& state, const int32_t* ids, size_t count,
             const std::vector<LoopObservation>& loops = {});

  BundleResult solve(int iterations, double tolerance);
  /// Precision over the given keyframes at the present state of the problem.
  BundlePrecision precision(const int32_t* ids, size_t count);

  /// Copies poses, positions and intrinsics of the problem into the map it was built from.
  void write_back(State* state) const;

  const BundleProblem& problem() const { return problem_; }
  size_t cameras() const { return keyframes_.size(); }
  size_t points() const { return landmarks_.size(); }
  int32_t keyframe_of(size_t camera) const { return keyframes_[camera]; }
  int32_t landmark_of(size_t point) const { return landmarks_[point]; }
  uint32_t generation_of(size_t point) const { return generations_[point]; }

  int64_t bytes() const;

 private:
  void collect_landmarks(const State& state, const int32_t* ids, size_t count);
  void add_cameras(const State& state, const int32_t* ids, size_t count);
  void add_landmark(const State& state, int32_t slot, const std::vector<LoopObservation>& loops);

  BundleProblem problem_;
  BundleAdjuster adjuster_;
  BundleOptions options_;
  std::vector<int32_t> keyframes_;     // of each camera
  std::vector<int32_t> landmarks_;     // of each point
  std::vector<uint32_t> generations_;  // of each point's landmark
  std::vector<int32_t> wanted_;        // landmarks to add
  std::vector<int32_t> camera_of_;     // by slot of the keyframe, -1: none
  std::vector<uint8_t> marked_;        // by landmark: in wanted_
  std::vector<int32_t> camera_scratch_;
};

}  // namespace unisim::geometric
