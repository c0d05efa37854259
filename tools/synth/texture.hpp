// SPDX-License-Identifier: MIT
// A painted surface as a pyramid of box-filtered levels, sampled over the footprint of a pixel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/synth/canvas.hpp"

namespace unisim::synth {

/// Where a pixel looks at a surface: position and its change per pixel column and row, all as
/// fractions of the surface's width and height.
struct Footprint {
  float s = 0;
  float t = 0;
  float ds_du = 0;
  float dt_du = 0;
  float ds_dv = 0;
  float dt_dv = 0;
};

class Texture {
 public:
  explicit Texture(const Canvas& canvas);

  /// Mean colour under a pixel's footprint: trilinear probes along its longer axis.
  Color sample(const Footprint& footprint) const;

 private:
  struct Level {
    int columns = 0;
    int rows = 0;
    std::vector<std::array<uint8_t, 4>> texels;
  };

  static Level halve(const Level& level);
  static Eigen::Vector4f bilinear(const Level& level, float s, float t);
  Eigen::Vector4f trilinear(float level, float s, float t) const;

  std::vector<Level> levels_;
};

}  // namespace unisim::synth
