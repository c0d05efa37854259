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

/// One level of a texture; a texel is red, green, blue and a byte of padding.
struct TextureLevel {
  int columns = 0;
  int rows = 0;
  std::vector<std::array<uint8_t, 4>> texels;
};

class Texture {
 public:
  explicit Texture(const Canvas& canvas);

  /// Mean colour under a pixel's footprint: trilinear probes along its longer axis.
  Color sample(const Footprint& footprint) const;

 private:
  std::vector<TextureLevel> levels_;
};

}  // namespace unisim::synth
