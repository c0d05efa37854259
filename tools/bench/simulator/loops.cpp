// SPDX-License-Identifier: MIT
// Where a walk comes back to a place it has seen.
#include "tools/bench/simulator/loops.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::simulator {
namespace {

constexpr int32_t kGap = 60;        // keyframes between query and match
constexpr int32_t kSpacing = 14;    // keyframes per loop
constexpr int32_t kFirstMatch = 8;  // keyframes before it are not offered
constexpr double kDistance = 0.35;  // m that count as much as
constexpr double kAngle = 30.0;     // degrees between viewing directions
constexpr double kDegrees = 57.29577951308232;

// Below 1 two views see the same place.
double difference(const RigidPose& a, const RigidPose& b) {
  const double distance = (a.t - b.t).norm() / kDistance;
  if (distance >= 1.0) return distance;
  const double cosine = std::clamp(a.R.col(2).dot(b.R.col(2)), -1.0, 1.0);
  return distance + kDegrees * std::acos(cosine) / kAngle;
}

bool far_apart(const RigidPose& a, const RigidPose& b) {
  return (a.t - b.t).norm() > 0.8 || a.R.col(2).dot(b.R.col(2)) < 0.3;
}

}  // namespace

int32_t Loop::first_around(int32_t keyframe, int32_t keyframes) {
  return std::clamp(keyframe - kLoopHalf / 2, 0, keyframes - kLoopHalf);
}

std::vector<Loop> find_loops(const World& world) {
  std::vector<Loop> loops;
  for (int32_t start = 0; start < world.keyframes(); start += kSpacing) {
    double best = 1.0;
    Loop loop;
    for (int32_t q = start; q < std::min(start + kSpacing, world.keyframes()); ++q) {
      for (int32_t m = kFirstMatch; m < q - kGap; ++m) {
        const double score = difference(world.T_world_kf[static_cast<size_t>(q)],
                                        world.T_world_kf[static_cast<size_t>(m)]);
        if (score >= best) continue;
        best = score;
        loop = {q, m, false};
      }
    }
    if (best < 1.0) loops.push_back(loop);
  }
  return loops;
}

std::vector<Loop> with_false_loops(const World& world, std::vector<Loop> loops, double share,
                                   uint64_t seed) {
  constexpr int32_t kFirstQuery = 70;
  constexpr int32_t kFalseGap = 55;
  constexpr int kTrials = 200;
  if (share <= 0.0 || world.keyframes() <= kFirstQuery + kLoopHalf) return loops;
  NoiseSource noise(synth::derive_seed(seed, 1));
  const double wanted =
      share * static_cast<double>(std::max<size_t>(1, loops.size())) / (1 - share);
  const int count = std::max(1, static_cast<int>(std::lround(wanted)));
  for (int k = 0; k < count; ++k) {
    Loop loop{0, 0, true};
    for (int trial = 0; trial < kTrials; ++trial) {
      loop.query = kFirstQuery + noise.below(world.keyframes() - kLoopHalf - kFirstQuery);
      loop.match = kFirstMatch + noise.below(loop.query - kFalseGap - kFirstMatch);
      if (far_apart(world.T_world_kf[static_cast<size_t>(loop.query)],
                    world.T_world_kf[static_cast<size_t>(loop.match)])) {
        break;
      }
    }
    loops.push_back(loop);
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const Loop& a, const Loop& b) { return a.query < b.query; });
  return loops;
}

}  // namespace unisim::simulator
