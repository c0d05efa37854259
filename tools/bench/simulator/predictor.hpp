// SPDX-License-Identifier: MIT
// Simulated feed-forward predictor: poses and depth of a few keyframes, each inference in a unit of
// its own.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/bench/simulator/loops.hpp"
#include "tools/bench/simulator/noise_model.hpp"
#include "tools/bench/simulator/world.hpp"

namespace unisim::simulator {

/// Poses into a common frame and depth of some keyframes, in the unit of this inference.
struct Prediction {
  std::vector<int32_t> keyframes;  ///< ascending
  std::vector<RigidPose> T_local_kf;
  std::vector<DepthMap> depth;  ///< 0: no depth
};

/// The prediction of an item depends on the seed and the item, not on what was asked before.
class Predictor {
 public:
  /// @param world outlives the predictor
  Predictor(const World& world, uint64_t seed, const NoiseModel& model = NoiseModel());

  /// Keyframes i and i + 1; i is the frame.
  Prediction pair(int32_t i) const;
  /// Consecutive keyframes.
  Prediction window(int32_t first, int32_t count) const;
  /// Keyframes around both places of a loop.
  Prediction loop(const Loop& loop) const;

 private:
  double unit(const std::vector<int32_t>& keyframes, double sigma, NoiseSource* noise) const;
  DepthMap observe(int32_t keyframe, double log_scale, NoiseSource* noise) const;
  Prediction infer(const std::vector<int32_t>& keyframes, int32_t origin, const Loop* loop,
                   NoiseSource* noise) const;

  const World& world_;
  uint64_t seed_;
  NoiseModel model_;
};

}  // namespace unisim::simulator
