// SPDX-License-Identifier: MIT
// Normal numbers that are the same on every machine.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "tools/synth/random.hpp"

namespace unisim::simulator {

/// Box-Muller, one half of each pair.
class NoiseSource {
 public:
  explicit NoiseSource(uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) { return random_.uniform(low, high); }
  int below(int count) { return random_.below(count); }

  double normal(double sigma = 1.0) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random_.uniform()));
    return sigma * radius * std::cos(kTurn * random_.uniform());
  }

  Eigen::Vector3d normal3(double sigma) {
    const double x = normal(sigma);
    const double y = normal(sigma);
    const double z = normal(sigma);
    return {x, y, z};
  }

 private:
  static constexpr double kTurn = 6.283185307179586;
  synth::Random random_;
};

}  // namespace unisim::simulator
